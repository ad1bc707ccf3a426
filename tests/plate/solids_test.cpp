// Solids with reference nodes, beams and shells: which nodes have rotations, and what the assembled
// system makes of them.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "coupled_models.hpp"
#include "mesh/element_types.hpp"
#include "mesh/extrude.hpp"
#include "mesh/generators.hpp"
#include "mesh/nodal_matrices.hpp"
#include "plate/assembly/inertia_integrals.hpp"
#include "plate/assembly/recovery.hpp"
#include "plate/dofs/free_motions.hpp"

namespace chladni::plate {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector3d;
using testing::average;
using testing::dofs_of;
using testing::energy;
using testing::error_of;
using testing::expect_words;
using testing::link;
using testing::map_of;
using testing::random_motion;

/// A block [0, 2] x [0, 1] x [0, 0.5] of two by two hexahedra: "plate", its faces "left", "right",
/// "top_face" and so on, and the upright edge "corner".
mesh::Mesh block(int order = 2)
{
  return mesh::extruded(
      testing::rectangle({.a = 2.0, .b = 1.0, .n_x = 2, .n_y = 2, .order = order}),
      {.from = 0.0, .to = 0.5}, {});
}

int add_node(mesh::Mesh& mesh, const std::array<double, 3>& x, const std::string& group)
{
  mesh.positions.push_back(x);
  mesh.node_numbers.push_back(mesh.node_numbers.back() + 1);
  mesh.groups.push_back({.name = group, .dimension = 0, .nodes = {mesh.n_nodes() - 1}});
  return mesh.n_nodes() - 1;
}

/// Elements with the group `name`.
void add_elements(mesh::Mesh& mesh, mesh::ElementBlock elements, const std::string& name)
{
  const auto group = static_cast<int>(mesh.groups.size());
  mesh.groups.push_back(
      {.name = name, .dimension = mesh::dimension(elements.shape), .nodes = elements.nodes});
  const auto n = std::ssize(elements.nodes) / elements.nodes_per_element;
  for (Index e = 0; e < n; ++e) {
    elements.numbers.push_back(1000 + std::ssize(mesh.groups) * 10 + e);
    elements.group.push_back(group);
  }
  mesh.blocks.push_back(std::move(elements));
}

/// The block with the beam "shaft" from "foot" at the middle of its face "right" to "tip", and the
/// shell "sheet" beside its face "top_face", of which "seat" is an edge.
mesh::Mesh mixed()
{
  mesh::Mesh mesh = block();
  const int foot = add_node(mesh, {2.0, 0.5, 0.25}, "foot");
  const int tip = add_node(mesh, {3.0, 0.7, 0.25}, "tip");
  add_elements(
      mesh, {.shape = mesh::Shape::line, .order = 1, .nodes_per_element = 2, .nodes = {foot, tip}},
      "shaft");
  std::vector<int> corners;
  for (const auto& x :
       {std::array{0.0, 0.2, 0.6}, {0.0, 0.8, 0.6}, {0.0, 0.2, 1.6}, {0.0, 0.8, 1.6}})
    corners.push_back(add_node(mesh, x, "sheet_" + std::to_string(corners.size())));
  mesh.groups.push_back({.name = "seat", .dimension = 1, .nodes = {corners[0], corners[1]}});
  add_elements(
      mesh,
      {.shape = mesh::Shape::quadrilateral, .order = 1, .nodes_per_element = 4, .nodes = corners},
      "sheet");
  return mesh;
}

const std::vector<ShellSection> shells{
    {.group = "sheet", .material = testing::material, .thickness = 0.02}};
const std::vector<BeamSection> beams{{.group = "shaft",
                                      .material = testing::material,
                                      .area = 0.01,
                                      .I_y = 1e-5,
                                      .I_z = 1e-5,
                                      .J = 2e-5}};
const std::vector<SolidSection> solids{{.group = "plate", .material = testing::material}};
const std::vector<PointMass> masses{
    {.at = "hub", .mass = 300.0, .inertia = {9.0, 8.0, 7.0}, .offset = {0.1, 0.0, 0.2}}};

const std::vector<Coupling> hub{{.name = "hub", .group = "left", .at = std::array{-0.3, 0.2, 0.1}}};

/// The shaft at the right face, the sheet at the top: the face follows a node of the beam, and the
/// sheet a node that the top face moves.
std::vector<Coupling> joints(CouplingKind top)
{
  std::vector<Coupling> all = hub;
  all.push_back({.name = {}, .group = "right", .to = "foot"});
  all.push_back({.name = "saddle", .group = "patch", .kind = top});
  all.push_back({.name = {}, .group = "seat", .to = "saddle"});
  return all;
}

/// With "patch", the nodes in the middle of the top face.
mesh::Mesh mixed_with_patch()
{
  mesh::Mesh mesh = mixed();
  mesh::Group patch{.name = "patch", .dimension = 2, .nodes = {}};
  for (const int node : mesh::find_group(mesh, "top_face").nodes)
    if (mesh.positions[std::size_t(node)][0] > 0.4 && mesh.positions[std::size_t(node)][0] < 1.6)
      patch.nodes.push_back(node);
  mesh.groups.push_back(patch);
  return mesh;
}

System mixed_system(const mesh::Mesh& mesh, const std::vector<Coupling>& couplings)
{
  return assemble(mesh, {.shells = shells, .beams = beams, .solids = solids, .masses = masses},
                  map_of(mesh, couplings), PETSC_COMM_WORLD);
}

template <typename Action>
std::string words_of(const Action& action)
{
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The rotation phi about a point, and the translation that moves the origin by u, in the DOFs of
/// the system.
petsc::Vector rigid_motion(const System& system, const Vector3d& u, const Vector3d& phi)
{
  petsc::Vector q;
  petsc::check(MatCreateVecs(system.K, q.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(q, &first, &last));
  for (int node = 0; node < system.dofs.n_nodes(); ++node) {
    Eigen::Vector<double, 6> motion;
    motion << u + phi.cross(system.dofs.position(node)), phi;
    for (int c = 0; c < 6; ++c) {
      const auto dof = system.dofs.dof(node, c);
      if (dof && *dof >= first && *dof < last)
        petsc::check(VecSetValue(q, *dof, motion[c], INSERT_VALUES));
    }
  }
  petsc::check(VecAssemblyBegin(q));
  petsc::check(VecAssemblyEnd(q));
  return q;
}

TEST(Solids, HaveThreeDofsANodeAndSixWhereSomethingTurns)
{
  const mesh::Mesh mesh = mixed_with_patch();
  const DofMap map = map_of(mesh, joints(CouplingKind::averaging));
  std::vector<int> seen(std::size_t(map.n_dofs()), 0);
  for (int node = 0; node < map.n_nodes(); ++node) {
    const std::string of = node < mesh.n_nodes()
                               ? std::to_string(mesh.node_numbers[std::size_t(node)])
                               : map.reference_name(node);
    const bool is_of_block = node < block().n_nodes();
    if (map.is_dependent(node)) continue;
    EXPECT_EQ(map.components_of(node).size(), is_of_block ? 3U : 6U) << of;
    for (int c = 0; c < 6; ++c)
      if (const auto dof = map.dof(node, c)) ++seen[std::size_t(*dof)];
  }
  EXPECT_EQ(std::ranges::count(seen, 1), map.n_dofs());
  const int left = mesh::find_group(mesh, "left").nodes.front();
  EXPECT_TRUE(map.has_rotations(left));  // by the hub that it follows
  EXPECT_EQ(map.dof(left, 0), std::nullopt);
}

TEST(Solids, FeelNoForceInRigidMotionBesideBeamsAndShells)
{
  const mesh::Mesh mesh = mixed_with_patch();
  for (const CouplingKind top : {CouplingKind::rigid, CouplingKind::averaging}) {
    const System system = mixed_system(mesh, joints(top));
    const petsc::Vector q = rigid_motion(system, {0.3, -0.2, 0.5}, {0.4, 0.7, -0.6});
    double K_norm = 0.0, q_norm = 0.0, f_norm = 0.0;
    petsc::Vector f;
    petsc::check(VecDuplicate(q, f.put()));
    petsc::check(MatMult(system.K, q, f));
    petsc::check(VecNorm(f, NORM_2, &f_norm));
    petsc::check(VecNorm(q, NORM_2, &q_norm));
    petsc::check(MatNorm(system.K, NORM_FROBENIUS, &K_norm));
    EXPECT_LT(f_norm, 1e-14 * K_norm * q_norm);  // sums of round-off
    EXPECT_EQ(n_free_motions(free_parts(mesh, system.dofs, {})), 6);
    EXPECT_EQ(system.dofs.has_combined_motions(), top == CouplingKind::averaging);
  }
}

TEST(Solids, GiveTheGeometricRigidMotions)
{
  const System system = mixed_system(mixed_with_patch(), joints(CouplingKind::rigid));
  const petsc::Matrix R = rigid_motions(system);
  petsc::Matrix K_R;
  petsc::check(MatMatMult(system.K, R, MAT_INITIAL_MATRIX, PETSC_DEFAULT, K_R.put()));
  double K_norm = 0.0, R_norm = 0.0, force = 0.0;
  petsc::check(MatNorm(system.K, NORM_FROBENIUS, &K_norm));
  petsc::check(MatNorm(R, NORM_FROBENIUS, &R_norm));
  petsc::check(MatNorm(K_R, NORM_FROBENIUS, &force));
  EXPECT_GT(R_norm, std::sqrt(3.0 * system.dofs.n_dofs() / 6.0));  // all nodes move
  EXPECT_LT(force, 1e-14 * K_norm * R_norm);
}

TEST(Solids, HaveTheMassOfTheWholeAssembly)
{
  const mesh::Mesh mesh = mixed_with_patch();
  const std::vector<Coupling> couplings = joints(CouplingKind::averaging);
  const System system = mixed_system(mesh, couplings);
  const Structure structure{.shells = shells, .beams = beams, .solids = solids, .masses = masses};
  const MassMoments moments =
      mass_moments(mass_model(mesh, structure, system.dofs, PETSC_COMM_WORLD));
  const double rho = testing::material.density;
  const double of_block = rho, of_shaft = rho * 0.01 * std::hypot(1.0, 0.2),
               of_sheet = rho * 0.6 * 0.02;
  EXPECT_NEAR(moments.mass, of_block + of_shaft + of_sheet + 300.0, 1e-10 * of_block);
  const Vector3d first = of_block * Vector3d(1.0, 0.5, 0.25) + of_shaft * Vector3d(2.5, 0.6, 0.25) +
                         of_sheet * Vector3d(0.0, 0.5, 1.1) + 300.0 * Vector3d(-0.2, 0.2, 0.3);
  EXPECT_LT((moments.first - first).norm(), 1e-10 * of_block);
  const Vector3d phi(0.4, 0.7, -0.6);
  const Eigen::Matrix3d I = moments.second.trace() * Eigen::Matrix3d::Identity() - moments.second;
  // Sections that turn with the beam and the director have inertia of their own, of which the mass
  // points know.
  EXPECT_NEAR(energy(system.M, rigid_motion(system, Vector3d::Zero(), phi)), phi.dot(I * phi),
              1e-9 * phi.dot(I * phi));
  EXPECT_NEAR(energy(system.M, rigid_motion(system, Vector3d::UnitY(), Vector3d::Zero())),
              moments.mass, 1e-10 * moments.mass);
}

/// The upper triangle of a matrix of solids by nodes, as another program gives it.
std::vector<mesh::MatrixEntry> entries_of(Mat A, const DofMap& dofs, int n_nodes)
{
  PetscInt n = 0, first = 0, last = 0;
  petsc::check(MatGetSize(A, &n, nullptr));
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  MatrixXd whole = MatrixXd::Zero(n, n);
  for (PetscInt i = first; i < last; ++i)
    for (PetscInt j = 0; j < n; ++j) petsc::check(MatGetValue(A, i, j, &whole(i, j)));
  MPI_Allreduce(MPI_IN_PLACE, whole.data(), int(whole.size()), MPI_DOUBLE, MPI_SUM,
                PETSC_COMM_WORLD);
  std::vector<mesh::MatrixEntry> entries;
  for (int a = 0; a < n_nodes; ++a)
    for (int b = a; b < n_nodes; ++b)
      for (int i = 0; i < 3; ++i)
        for (int j = a == b ? i : 0; j < 3; ++j) {
          const double value = whole(*dofs.dof(a, i), *dofs.dof(b, j));
          if (value != 0.0)
            entries.push_back({.row = 6 * a + i, .column = 6 * b + j, .value = value});
        }
  return entries;
}

TEST(Solids, OfForeignMatricesHaveTheIntegralsOfTheirElements)
{
  mesh::Mesh mesh = block();
  const Structure own{.solids = solids}, foreign;
  const System system = assemble(mesh, own, map_of(mesh, {}), PETSC_COMM_WORLD);
  const MassMoments expected = mass_moments(mass_model(mesh, own, system.dofs, PETSC_COMM_WORLD));
  mesh.matrices = std::make_shared<const mesh::NodalMatrices>(
      mesh::NodalMatrices{.n_components = std::vector<std::int8_t>(std::size_t(mesh.n_nodes()), 3),
                          .K = entries_of(system.K, system.dofs, mesh.n_nodes()),
                          .M = entries_of(system.M, system.dofs, mesh.n_nodes()),
                          .C = {},
                          .H = {}});
  EXPECT_TRUE(mesh::is_mass_of_points(*mesh.matrices));
  const System same = assemble(mesh, foreign, map_of(mesh, {}), PETSC_COMM_WORLD);
  const MassModel model = mass_model(mesh, foreign, same.dofs, PETSC_COMM_WORLD);
  const MassMoments found = mass_moments(model);
  EXPECT_NEAR(found.mass, expected.mass, 1e-13 * expected.mass);
  EXPECT_LT((found.first - expected.first).norm(), 1e-13 * expected.mass);
  EXPECT_LT((found.second - expected.second).norm(), 1e-13 * expected.mass);
  const Vector3d u(0.3, -0.2, 0.5), phi(0.4, 0.7, -0.6);
  petsc::Matrix sum = displacement_product(model, 0, 0);
  for (int k = 1; k < 3; ++k)
    petsc::check(MatAXPY(sum, 1.0, displacement_product(model, k, k), DIFFERENT_NONZERO_PATTERN));
  const petsc::Vector here = rigid_motion(system, u, phi), there = rigid_motion(same, u, phi);
  const double kinetic = energy(system.M, here);
  EXPECT_NEAR(energy(same.M, there), kinetic, 1e-12 * kinetic);
  EXPECT_NEAR(energy(sum, there), kinetic, 1e-12 * kinetic);
  EXPECT_LT(energy(same.K, there), 1e-12 * energy(same.K, random_motion(same)));
}

TEST(Solids, AreHeldByTheirHub)
{
  const mesh::Mesh mesh = block();
  const DofMap map = map_of(mesh, hub);
  const auto n_free = [&](const std::vector<Support>& supports) {
    return n_free_motions(free_parts(mesh, map, held_dofs(mesh, map, supports)));
  };
  EXPECT_EQ(n_free({{.group = "hub", .components = {0, 1, 2, 3, 4, 5}}}), 0);
  EXPECT_EQ(n_free({{.group = "hub", .components = {0, 1, 2}}}), 3);
  EXPECT_EQ(n_free({{.group = "hub", .components = {3, 4, 5}}}), 3);
  EXPECT_EQ(n_free({{.group = "corner", .components = {0, 1, 2}}}), 1);  // about the held edge
}

/// int u dA and int r x u dA over the top face, r from its centre.
Eigen::Vector<double, 6> integrals_over_top(const mesh::Mesh& mesh, const MatrixXd& motions)
{
  const std::vector<int> top = mesh::find_group(mesh, "top_face").nodes;
  Eigen::Vector<double, 6> sums = Eigen::Vector<double, 6>::Zero();
  for (const mesh::FreeFace& face : mesh::free_faces(mesh)) {
    if (!std::ranges::all_of(face.nodes,
                             [&](int node) { return std::ranges::count(top, node) > 0; }))
      continue;
    const FaceRule& rule =
        face_rule(static_cast<int>(face.nodes.size()), mesh.blocks[std::size_t(face.block)].order);
    const MatrixXd u = rule.basis.N * motions(face.nodes, Eigen::seqN(0, 3));
    MatrixXd x(std::ssize(face.nodes), 3);
    for (Index i = 0; i < x.rows(); ++i)
      x.row(i) = Eigen::RowVector3d(mesh.positions[std::size_t(face.nodes[std::size_t(i)])].data());
    const MatrixXd at = rule.basis.N * x, a_1 = rule.basis.N_xi * x, a_2 = rule.basis.N_eta * x;
    for (Index q = 0; q < at.rows(); ++q) {
      const Vector3d r = at.row(q).transpose() - Vector3d(1.0, 0.5, 0.5), u_q = u.row(q);
      const double dA =
          rule.points.weight[q] * Vector3d(a_1.row(q)).cross(Vector3d(a_2.row(q))).norm();
      sums.head<3>() += dA * u_q;
      sums.tail<3>() += dA * r.cross(u_q);
    }
  }
  return sums;
}

TEST(Solids, AreFollowedByTheMeanOfTheirFace)
{
  for (const int order : {2, 3}) {
    const mesh::Mesh mesh = block(order);
    const System system = assemble(mesh, {.solids = solids},
                                   map_of(mesh, {average("pad", "top_face")}), PETSC_COMM_WORLD);
    const MatrixXd motions = node_motions(system.dofs, random_motion(system));
    const Eigen::Vector<double, 6> sums = integrals_over_top(mesh, motions);
    const Eigen::RowVectorXd pad = motions.row(system.dofs.reference_node("pad").value());
    // Area 2, int y^2 = 1 / 6, int x^2 = 2 / 3. The six solved displacements are up to 1e3.
    EXPECT_LT((sums.head<3>() / 2.0 - pad.head<3>().transpose()).norm(), 1e-11) << order;
    const Vector3d theta(6.0 * sums[3], 1.5 * sums[4], 6.0 / 5.0 * sums[5]);
    EXPECT_LT((theta - pad.tail<3>().transpose()).norm(), 1e-11) << order;
  }
}

/// Expects the energies of the plain system where nodes have a motion that another system has.
void expect_same_energies(const System& plain, const System& other, Vec q)
{
  const MatrixXd motions = node_motions(other.dofs, q);
  petsc::Vector u;
  petsc::check(MatCreateVecs(plain.K, u.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(u, &first, &last));
  for (int node = 0; node < plain.dofs.n_nodes(); ++node)
    for (int c = 0; c < 3; ++c)
      if (const int dof = plain.dofs.dof(node, c).value(); dof >= first && dof < last)
        petsc::check(VecSetValue(u, dof, motions(node, c), INSERT_VALUES));
  petsc::check(VecAssemblyBegin(u));
  petsc::check(VecAssemblyEnd(u));
  // Sums of some 1e4 terms in another order.
  EXPECT_NEAR(energy(other.K, q) / energy(plain.K, u), 1.0, 1e-11);
  EXPECT_NEAR(energy(other.M, q) / energy(plain.M, u), 1.0, 1e-11);
}

mesh::Mesh solid_annulus(const std::vector<mesh::RingOptions>& track = {})
{
  mesh::Mesh flat = mesh::annulus({.inner_radius = 0.025,
                                   .outer_radius = 0.162,
                                   .element_size = 0.06,
                                   .element_order = 2,
                                   .rings = track});
  std::erase_if(flat.groups, [](const mesh::Group& group) { return group.name == "track"; });
  return mesh::extruded(flat, {.from = -0.01, .to = 0.01}, track);
}

const std::vector<SolidSection> of_annulus{{.group = "disc", .material = testing::material}};

TEST(Solids, AreTheSameInTheHarmonicsOfARing)
{
  const mesh::Mesh mesh = solid_annulus({{.name = "track", .radius = 0.13, .nodes = 12}});
  const std::vector<RingHarmonics> rings{{"track", 3}};
  const System plain = assemble(mesh, {.solids = of_annulus}, map_of(mesh, {}), PETSC_COMM_WORLD);
  const System harmonic =
      assemble(mesh, {.solids = of_annulus}, dofs_of(mesh, {.rings = rings}), PETSC_COMM_WORLD);
  ASSERT_EQ(plain.dofs.n_dofs(), harmonic.dofs.n_dofs());
  expect_same_energies(plain, harmonic, random_motion(harmonic));
  EXPECT_EQ(harmonic.dofs.harmonic_dof(harmonic.dofs.harmonic_rings()[0], 2, 3), std::nullopt);
}

/// Rings on both faces of a mesh without nodes at their places: one of points, closer than the
/// nodes of the mesh are on their circle, one of means over patches.
mesh::Mesh with_rings_on_faces(mesh::Mesh mesh)
{
  mesh::add_rings(
      mesh,
      std::vector<mesh::RingOptions>{
          {.name = "upper", .radius = 0.117, .nodes = 24, .z = 0.01, .on = mesh::RingOn::face},
          {.name = "lower",
           .radius = 0.121,
           .nodes = 9,
           .z = -0.01,
           .on = mesh::RingOn::face,
           .width = 0.03}});
  return mesh;
}

TEST(Solids, AreTheSameWithRingsOnTheirFaces)
{
  const mesh::Mesh without = solid_annulus(), mesh = with_rings_on_faces(without);
  const std::vector<Coupling> pad{average("pad", "inner_edge")};
  const std::vector<RingHarmonics> both{{"upper", 5}, {"lower", 2}};
  const System plain =
      assemble(without, {.solids = of_annulus}, map_of(without, {}), PETSC_COMM_WORLD);
  for (const Kinematics& kinematics :
       {Kinematics{}, Kinematics{.rings = both}, Kinematics{.couplings = pad, .rings = both}}) {
    const System system =
        assemble(mesh, {.solids = of_annulus}, dofs_of(mesh, kinematics), PETSC_COMM_WORLD);
    ASSERT_EQ(plain.dofs.n_dofs(), system.dofs.n_dofs());
    const petsc::Vector q = random_motion(system);
    expect_same_energies(plain, system, q);
    const MatrixXd motions = node_motions(system.dofs, q);
    for (const mesh::FaceNode& on_face : mesh.face_nodes) {
      Eigen::RowVectorXd mean = -motions.row(on_face.node);
      Vector3d place = -system.dofs.position(on_face.node);
      for (std::size_t j = 0; j < on_face.nodes.size(); ++j) {
        mean += on_face.weights[j] * motions.row(on_face.nodes[j]);
        place += on_face.weights[j] * system.dofs.position(on_face.nodes[j]);
      }
      EXPECT_LT(mean.norm(), 1e-11);  // the displacements that are solved for are up to 1e2
      EXPECT_LT(place.norm(), 1e-15);
    }
  }
}

TEST(Solids, KeepTheirRigidMotionsWithRingsOnTheirFaces)
{
  const mesh::Mesh mesh = with_rings_on_faces(solid_annulus());
  const System system = assemble(mesh, {.solids = of_annulus}, dofs_of(mesh, {}), PETSC_COMM_WORLD);
  EXPECT_FALSE(system.dofs.has_combined_motions());
  const petsc::Matrix R = rigid_motions(system);
  petsc::Matrix K_R;
  petsc::check(MatMatMult(system.K, R, MAT_INITIAL_MATRIX, PETSC_DEFAULT, K_R.put()));
  PetscReal of_K = 0.0, of_product = 0.0;
  petsc::check(MatNorm(system.K, NORM_INFINITY, &of_K));
  petsc::check(MatNorm(K_R, NORM_INFINITY, &of_product));
  EXPECT_LT(of_product, 1e-13 * of_K);
}

TEST(Solids, RefuseRingsOnFacesThatCannotBe)
{
  const auto of_ring = [](const mesh::RingOptions& ring, mesh::Mesh mesh = solid_annulus()) {
    return words_of([&] { mesh::add_rings(mesh, std::array{ring}); });
  };
  const mesh::RingOptions ring{
      .name = "upper", .radius = 0.1, .nodes = 12, .on = mesh::RingOn::face};
  expect_words(of_ring(ring),
               {"radius 0.1 m, angle 0 degrees", "at z = -0.01, 0.01 m", "say which"});
  mesh::RingOptions changed = ring;
  changed.z = 0.009;
  expect_words(of_ring(changed), {"at z = 0.009 m", "at z = -0.01, 0.01 m"});
  changed.z = 0.01;
  EXPECT_EQ(of_ring(changed), "");
  changed.radius = 0.17;
  expect_words(of_ring(changed), {"no face of solids there"});
  changed.radius = 0.155;
  changed.width = 0.02;
  expect_words(of_ring(changed), {"radius 0.16", "no face of solids there"});
  expect_words(of_ring(ring, testing::rectangle({.a = 1.0, .b = 1.0, .n_x = 1, .n_y = 1})),
               {"the mesh has none"});
  mesh::Mesh fine = solid_annulus();
  changed = {.name = "fine", .radius = 0.1, .nodes = 400, .z = 0.01, .on = mesh::RingOn::face};
  mesh::add_rings(fine, std::array{changed});
  expect_words(error_of(fine, Kinematics{}), {"ring \"fine\"", "take fewer nodes"});
  const mesh::Mesh mesh = with_rings_on_faces(solid_annulus());
  expect_words(error_of(mesh, {{.name = "hub", .group = "lower"}}),
               {"\"lower\"", "nodes on faces"});
  const std::vector<Support> supports{{.group = "top_face", .components = {2}}};
  const DofMap dofs = dofs_of(mesh, {});
  expect_words(words_of([&] { held_dofs(mesh, dofs, supports); }), {"follows \"upper\""});
}

TEST(Solids, RefuseWhatNeedsRotationsThatAreNotThere)
{
  const mesh::Mesh mesh = mixed_with_patch();
  mesh::Mesh shared = block();
  add_elements(shared,
               {.shape = mesh::Shape::line, .order = 1, .nodes_per_element = 2, .nodes = {0, 4}},
               "shaft");
  expect_words(error_of(shared, std::vector<Coupling>{}),
               {"node 1 belongs to a solid", "hinge", "[[coupling]]"});
  expect_words(error_of(mesh, {link("foot", "right")}),
               {"link of \"foot\" to \"right\"", "shell or beam", "hinge"});
  mesh::Mesh twice = block();
  add_node(twice, {2.0, 1.0, 0.7}, "above");
  expect_words(error_of(twice, {link("above", "corner")}),
               {"0.2 m away from node", "no rotations"});
  expect_words(error_of(mesh, {{.name = "hub", .group = "corner"}}),
               {"coupling \"hub\"", "one line", "couple more"});
}

TEST(Solids, TakeMassesAndSpringsWithoutMoments)
{
  mesh::Mesh mesh = block();
  for (const auto& [name, x] :
       {std::pair{"a", std::array{0.0, 1.0, 0.5}}, {"b", {2.0, 1.0, 0.5}}}) {
    const auto at = static_cast<int>(std::ranges::find(mesh.positions, x) - mesh.positions.begin());
    ASSERT_LT(at, mesh.n_nodes());
    mesh.groups.push_back({.name = name, .dimension = 0, .nodes = {at}});
  }
  const auto of_mass = [&](const PointMass& mass, const std::vector<Coupling>& couplings) {
    return words_of([&] { point_elements(mesh, {.masses = {&mass, 1}}, map_of(mesh, couplings)); });
  };
  const PointMass turning{.at = "left", .mass = 1.0, .inertia = {1.0, 1.0, 1.0}};
  EXPECT_EQ(of_mass({.at = "left", .mass = 1.0}, {}), "");
  expect_words(of_mass(turning, {}), {"mass at \"left\"", "node 1 of a solid", "no rotations"});
  expect_words(of_mass({.at = "left", .mass = 1.0, .offset = {0.1, 0.0, 0.0}}, {}), {"couple"});
  EXPECT_EQ(of_mass(turning, hub), "");  // which the nodes follow
  const auto of_spring = [&](const Spring& spring) {
    return words_of([&] { point_elements(mesh, {.springs = {&spring, 1}}, map_of(mesh, {})); });
  };
  EXPECT_EQ(of_spring({.at = "left", .stiffness = {1.0, 2.0, 3.0}}), "");
  expect_words(of_spring({.at = "left", .damping = {0.0, 0.0, 0.0, 0.0, 1.0}}), {"rotational"});
  EXPECT_EQ(of_spring({.at = "a", .to = "b", .stiffness = {1.0}}), "");
  expect_words(of_spring({.at = "a", .to = "b", .stiffness = {0.0, 1.0}}),
               {"spring at \"a\"", "beside the line between two nodes"});
}

TEST(Solids, RefuseMomentsAndHeldRotations)
{
  const mesh::Mesh mesh = block();
  const System with_hub = assemble(mesh, {.solids = solids}, map_of(mesh, hub), PETSC_COMM_WORLD);
  const auto of_moment = [&](const std::string& at) {
    const std::vector<Load> loads{NodalLoad{.group = at, .moment = {0.0, 1.0, 0.0}}};
    return words_of([&] { load_vector(mesh, with_hub, loads); });
  };
  expect_words(of_moment("right"), {"load on \"right\"", "no moment"});
  EXPECT_EQ(of_moment("hub"), "");
  const auto of_support = [&](const std::vector<int>& components) {
    const std::vector<Support> supports{{.group = "right", .components = components}};
    return words_of([&] { held_dofs(mesh, with_hub.dofs, supports); });
  };
  EXPECT_EQ(of_support({0, 3, 4, 5}), "");
  expect_words(of_support({3}), {"support of \"right\"", "no rotations to hold"});
}

}  // namespace
}  // namespace chladni::plate
