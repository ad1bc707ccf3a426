// Links, chains, averages, offsets and varying thickness, as the assembled system shows them.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "common/error.hpp"
#include "plate/free_motions.hpp"
#include "plate/point_elements.hpp"
#include "plate/recovery.hpp"
#include "small_disc.hpp"
#include "square_plate.hpp"

namespace chladni::plate {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

const Material material{.young = 2e11, .poisson = 0.3, .density = 8000.0};

mesh::Mesh plate()
{
  return testing::rectangle({.a = 2.0, .b = 1.0, .n_x = 4, .n_y = 3, .order = 2});
}

DofMap map_of(const mesh::Mesh& mesh, const std::vector<Coupling>& couplings)
{
  const int n = petsc::size(PETSC_COMM_WORLD);
  return make_dof_map(mesh, couplings, mesh::node_owners(mesh, n), n);
}

Coupling link(const std::string& group, const std::string& to)
{
  return {.name = {}, .group = group, .kind = CouplingKind::link, .to = to};
}

Coupling average(const std::string& name, const std::string& group)
{
  return {.name = name, .group = group, .kind = CouplingKind::averaging};
}

std::string error_of(const mesh::Mesh& mesh, const std::vector<Coupling>& couplings)
{
  try {
    map_of(mesh, couplings);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_words(const std::string& message, const std::vector<std::string>& words)
{
  for (const std::string& word : words) {
    EXPECT_NE(message.find(word), std::string::npos) << word << " is not in: " << message;
  }
}

TEST(Links, FollowTheirNearestNodes)
{
  const mesh::Mesh mesh = plate();
  const DofMap map = map_of(mesh, {link("top", "bottom")});
  for (const int node : mesh::find_group(mesh, "top").nodes) {
    ASSERT_TRUE(map.is_dependent(node));
    EXPECT_EQ(map.arm(node), (std::array<double, 3>{0.0, 1.0, 0.0}));
  }
}

TEST(Links, LeadThroughRigidCouplingsToTheirEnd)
{
  const mesh::Mesh mesh = plate();
  const DofMap map = map_of(mesh, {link("top", "bottom"), {.name = "base", .group = "bottom"}});
  for (const int node : mesh::find_group(mesh, "top").nodes) {
    EXPECT_EQ(map.reference[node], map.reference_node("base"));
    EXPECT_NEAR(map.arm(node)[1], 1.0, 1e-15);
  }
}

TEST(Links, NameBothCouplingsOfAConflict)
{
  const mesh::Mesh mesh = plate();
  expect_words(error_of(mesh, {link("top", "bottom"), {.name = "base", .group = "top"}}),
               {"two couplings", "link of \"top\" to \"bottom\"", "coupling \"base\""});
  expect_words(error_of(mesh, {link("top", "bottom"), link("bottom", "top")}),
               {"circle", "link of \"top\" to \"bottom\"", "link of \"bottom\" to \"top\""});
  expect_words(error_of(mesh, {link("right", "centre")}), {"both nearest", "pair"});
  expect_words(error_of(mesh, {link("corner", "top")}), {"belongs to both groups"});
  expect_words(error_of(mesh, {link("right", "rim")}), {"rim", "bottom"});
}

/// A vector of random entries, the same on each number of ranks.
petsc::Vector random_motion(const System& system)
{
  petsc::Vector q;
  petsc::check(MatCreateVecs(system.K, q.put(), nullptr));
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> entries(-1.0, 1.0);
  PetscInt n = 0, first = 0, last = 0;
  petsc::check(VecGetSize(q, &n));
  petsc::check(VecGetOwnershipRange(q, &first, &last));
  for (PetscInt i = 0; i < n; ++i) {
    const double value = entries(generator);
    if (i >= first && i < last) petsc::check(VecSetValue(q, i, value, INSERT_VALUES));
  }
  petsc::check(VecAssemblyBegin(q));
  petsc::check(VecAssemblyEnd(q));
  return q;
}

System disc_system(const mesh::Mesh& mesh, const std::vector<Coupling>& couplings)
{
  return assemble(mesh, testing::section, map_of(mesh, couplings), PETSC_COMM_WORLD);
}

TEST(Averages, AreTheRigidMotionThatFitsBest)
{
  const mesh::Mesh mesh = testing::small_disc();
  const System system = disc_system(mesh, {average("pad", "inner_edge")});
  const MatrixXd motions = node_motions(system.dofs, random_motion(system));
  const std::vector<int>& group = mesh::find_group(mesh, "inner_edge").nodes;
  const int reference = system.dofs.reference_node("pad").value();
  const auto position = [&](int node) { return Vector3d(system.dofs.positions[node].data()); };
  const Vector3d u_ref = motions.row(reference).head<3>();
  const Vector3d theta_ref = motions.row(reference).tail<3>();
  // What is left of the displacements has neither a mean nor a moment.
  Vector3d mean = Vector3d::Zero(), moment = Vector3d::Zero();
  for (const int node : group) {
    const Vector3d r = position(node) - position(reference);
    const Vector3d rest = motions.row(node).head<3>().transpose() - u_ref - theta_ref.cross(r);
    mean += rest;
    moment += r.cross(rest);
  }
  // Rotations are 1 / 0.025 m times displacements of order 1, solved for as combinations of 40
  // terms.
  EXPECT_LT(mean.norm(), 1e-10);
  EXPECT_LT(moment.norm(), 1e-10);
}

/// q^T A q
double energy(Mat A, Vec q)
{
  petsc::Vector A_q;
  petsc::check(VecDuplicate(q, A_q.put()));
  petsc::check(MatMult(A, q, A_q));
  double energy = 0.0;
  petsc::check(VecDot(q, A_q, &energy));
  return energy;
}

/// u^T A u for a motion of all nodes that is the same with and without a coupling.
double rotation_energy(const System& system, Mat A)
{
  petsc::Vector q;
  petsc::check(MatCreateVecs(system.K, q.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(q, &first, &last));
  for (int node = 0; node < system.dofs.n_nodes(); ++node) {
    const auto& x = system.dofs.positions[node];
    const std::array<double, 6> motion{0.0, 0.0, x[0] - 2.0 * x[1], -2.0, -1.0, 0.0};
    for (int c = 0; c < 6; ++c) {
      const auto dof = system.dofs.dof(node, c);
      if (!dof || *dof < first || *dof >= last) continue;
      petsc::check(VecSetValue(q, *dof, motion[c], INSERT_VALUES));
    }
  }
  petsc::check(VecAssemblyBegin(q));
  petsc::check(VecAssemblyEnd(q));
  return energy(A, q);
}

TEST(Averages, ChangeNeitherStiffnessNorMass)
{
  const mesh::Mesh mesh = testing::small_disc();
  const System free = disc_system(mesh, {});
  const System averaged = disc_system(mesh, {average("pad", "inner_edge")});
  PetscInt n_free = 0, n_averaged = 0;
  petsc::check(MatGetSize(free.K, &n_free, nullptr));
  petsc::check(MatGetSize(averaged.K, &n_averaged, nullptr));
  EXPECT_EQ(n_free, n_averaged);
  EXPECT_EQ(n_free_motions(free_parts(mesh, averaged, {})), 6);
  const double inertia = rotation_energy(free, free.M);
  EXPECT_NEAR(rotation_energy(averaged, averaged.M) / inertia, 1.0,
              1e-10);  // sums of cancelling terms
}

TEST(Averages, GiveTheReferenceNodeDofsOfItsOwn)
{
  const mesh::Mesh mesh = testing::small_disc();
  const DofMap map = map_of(mesh, {average("pad", "inner_edge")});
  const int reference = map.reference_node("pad").value();
  std::vector<int> dofs;
  int n_pivots = 0;
  for (int c = 0; c < 6; ++c) dofs.push_back(map.dof(reference, c).value());
  for (const int node : mesh::find_group(mesh, "inner_edge").nodes) {
    for (int c = 0; c < 6; ++c) {
      const auto dof = map.dof(node, c);
      if (!dof) ++n_pivots;
      EXPECT_TRUE(!dof || std::ranges::count(dofs, *dof) == 0);
    }
  }
  EXPECT_EQ(n_pivots, 6);
}

TEST(Averages, NameWhatTheyCannotDo)
{
  const mesh::Mesh mesh = plate();
  expect_words(error_of(mesh, {average("pad", "left")}), {"pad", "left", "one line"});
  expect_words(error_of(mesh, {average("pad", "corner")}), {"pad", "too few"});
  const mesh::Mesh disc = testing::small_disc();
  expect_words(error_of(disc, {average("a", "inner_edge"), average("b", "disc")}),
               {"coupling \"a\"", "coupling \"b\"", "in common"});
}

TEST(Averages, TakeNodesThatFollowARigidBody)
{
  mesh::Mesh mesh = testing::small_disc();
  mesh::Group both = mesh::find_group(mesh, "track");
  const std::vector<int> edge = mesh::find_group(mesh, "inner_edge").nodes;
  both.name = "both";
  both.nodes.insert(both.nodes.end(), edge.begin(), edge.end());
  mesh.groups.push_back(both);
  const System system =
      disc_system(mesh, {{.name = "hub", .group = "inner_edge"}, average("pad", "both")});
  const MatrixXd motions = node_motions(system.dofs, random_motion(system));
  Vector3d mean = Vector3d::Zero();
  const std::vector<int>& group = both.nodes;
  for (const int node : group) mean += motions.row(node).head<3>().transpose();
  mean /= static_cast<double>(group.size());
  const int pad = system.dofs.reference_node("pad").value();
  EXPECT_LT((mean - motions.row(pad).head<3>().transpose()).norm(), 1e-10);
}

TEST(Profile, IsLinearBetweenItsPlacesAndConstantBeyond)
{
  const Profile t(Coordinate::radius, {1.0, 2.0, 4.0}, {0.5, 0.1, 0.3});
  EXPECT_EQ(value_at(t, {0.3, 0.4, 9.0}), 0.5);
  EXPECT_NEAR(value_at(t, {0.9, 1.2, 9.0}), 0.3, 1e-15);
  EXPECT_NEAR(value_at(t, {0.0, 3.0, 0.0}), 0.2, 1e-15);
  EXPECT_EQ(value_at(t, {5.0, 0.0, 0.0}), 0.3);
  EXPECT_EQ(value_at(0.02, {5.0, 0.0, 0.0}), 0.02);
}

/// A plate of linear thickness over x whose mid-surface is off its mesh.
System tapered(const mesh::Mesh& mesh)
{
  const ShellSection section{.group = "plate",
                             .material = material,
                             .thickness = {Coordinate::x, {0.0, 2.0}, {0.1, 0.3}},
                             .offset = {Coordinate::x, {0.0, 2.0}, {0.05, 0.15}}};
  return assemble(mesh, std::vector{section}, map_of(mesh, {}), PETSC_COMM_WORLD);
}

TEST(Offset, LeavesSixRigidMotions)
{
  const mesh::Mesh mesh = plate();
  EXPECT_EQ(n_free_motions(free_parts(mesh, tapered(mesh), {})), 6);
}

TEST(Offset, MovesTheMassWithTheMidSurface)
{
  const mesh::Mesh mesh = plate();
  const System system = tapered(mesh);
  // w = x - 2 y is a rotation by theta = (-2, -1, 0): points at height z move by (-z, 2 z, x - 2
  // y). With t = 0.1 (1 + x), and the lower face in the plane of the mesh: int z^2 dz = t^3 / 3.
  const auto integrand = [](double x, double y) {
    const double t = 0.1 * (1.0 + x);
    return 8000.0 * (5.0 * t * t * t / 3.0 + t * (x - 2.0 * y) * (x - 2.0 * y));
  };
  double exact = 0.0;  // Gauss with 3 points: degree 5 in x, 2 in y
  const std::array<double, 3> g{-std::sqrt(0.6), 0.0, std::sqrt(0.6)};
  const std::array<double, 3> w{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      exact += 0.5 * w[i] * w[j] * integrand(1.0 + g[i], 0.5 + 0.5 * g[j]);
    }
  }
  // The directors are normal to the mesh, the faces of the mid-surface are inclined by 0.05.
  EXPECT_NEAR(rotation_energy(system, system.M) / exact, 1.0, 1e-12);
}

TEST(PointElements, ActOnTheMotionOfAverages)
{
  const mesh::Mesh mesh = testing::small_disc();
  const std::vector<Coupling> couplings{average("pad", "inner_edge"), link("track", "outer_edge")};
  const std::array<double, 6> k{1e9, 2e9, 3e9, 4e5, 5e5, 6e5}, c{1, 2, 3, 4, 5, 6};
  const PointMass mass{.at = "pad", .mass = 50.0, .inertia = {1, 2, 3}, .offset = {0, 0.1, 0.2}};
  const Spring ground{.at = "pad", .stiffness = k, .damping = c};
  const System plain = disc_system(mesh, couplings);
  const System with =
      assemble(mesh, {.shells = testing::section, .masses = {&mass, 1}, .springs = {&ground, 1}},
               map_of(mesh, couplings), PETSC_COMM_WORLD);
  const petsc::Vector q = random_motion(with);
  const int pad = with.dofs.reference_node("pad").value();
  const Eigen::Vector<double, 6> u = node_motions(with.dofs, q).row(pad);
  const auto of = [&](const std::array<double, 6>& d) {
    return u.dot(Eigen::Map<const Eigen::Vector<double, 6>>(d.data()).asDiagonal() * u);
  };
  // Differences of sums whose terms are larger: K of the disc has entries of 1e11.
  EXPECT_NEAR((energy(with.K, q) - energy(plain.K, q)) / of(k), 1.0, 1e-6);
  EXPECT_NEAR((energy(with.M, q) - energy(plain.M, q)) / u.dot(point_mass_matrix(mass) * u), 1.0,
              1e-10);
  EXPECT_NEAR(energy(with.C, q) / of(c), 1.0, 1e-10);
}

/// The plate with a beam on its lower edge, whose nodes are those of the plate.
mesh::Mesh stiffened_plate()
{
  mesh::Mesh mesh = plate();
  const mesh::Group& edge = mesh::find_group(mesh, "bottom");
  mesh::ElementBlock line{.shape = mesh::Shape::line,
                          .order = static_cast<int>(edge.nodes.size()) - 1,
                          .nodes_per_element = static_cast<int>(edge.nodes.size()),
                          .numbers = {1000},
                          .nodes = edge.nodes,
                          .group = {static_cast<int>(&edge - mesh.groups.data())}};
  mesh.blocks.push_back(line);
  return mesh;
}

TEST(Offset, IsThatOfTheShellsAndNotOfBeamsAtTheirNodes)
{
  const BeamSection beam{
      .group = "bottom", .material = material, .area = 0.1, .I_y = 1e-3, .I_z = 1e-3, .J = 2e-3};
  const mesh::Mesh bare = plate(), stiffened = stiffened_plate();
  const auto energies = [&](double offset) {
    const ShellSection shell{
        .group = "plate", .material = material, .thickness = 0.1, .offset = offset};
    const System without =
        assemble(bare, {.shells = {&shell, 1}}, map_of(bare, {}), PETSC_COMM_WORLD);
    const System with = assemble(stiffened, {.shells = {&shell, 1}, .beams = {&beam, 1}},
                                 map_of(stiffened, {}), PETSC_COMM_WORLD);
    EXPECT_EQ(n_free_motions(free_parts(stiffened, with, {})), 6);
    return std::array{rotation_energy(without, without.M), rotation_energy(with, with.M)};
  };
  const auto [flat, flat_with] = energies(0.0);
  const auto [moved, moved_with] = energies(0.2);
  EXPECT_GT(moved, 1.05 * flat);
  EXPECT_NEAR((moved_with - moved) / (flat_with - flat), 1.0, 1e-12);  // round-off of sums
}

TEST(Offset, AndLinksAreThoseOfTheWholeModelWhereComponentsAreHeld)
{
  const mesh::Mesh mesh = plate();
  const ShellSection section{
      .group = "plate", .material = material, .thickness = 0.1, .offset = 0.03};
  const std::vector<Coupling> links{link("top", "bottom")};
  const System whole = assemble(mesh, std::vector{section}, map_of(mesh, links), PETSC_COMM_WORLD);
  DofMap map = map_of(mesh, links);
  map.components = {0, 2, 4};
  const System part = assemble(mesh, std::vector{section}, std::move(map), PETSC_COMM_WORLD);
  petsc::Vector q_whole, q_part;
  petsc::check(MatCreateVecs(whole.K, q_whole.put(), nullptr));
  petsc::check(MatCreateVecs(part.K, q_part.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(q_part, &first, &last));
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    for (const int c : part.dofs.components) {
      const auto dof = part.dofs.dof(node, c);
      if (!dof || *dof < first || *dof >= last) continue;
      const double value = std::sin(double(node + 7 * c));
      petsc::check(VecSetValue(q_part, *dof, value, INSERT_VALUES));
      petsc::check(VecSetValue(q_whole, *whole.dofs.dof(node, c), value, INSERT_VALUES));
    }
  }
  for (Vec q : {Vec(q_whole), Vec(q_part)}) {
    petsc::check(VecAssemblyBegin(q));
    petsc::check(VecAssemblyEnd(q));
  }
  EXPECT_NEAR(energy(part.K, q_part) / energy(whole.K, q_whole), 1.0, 1e-12);  // round-off of sums
  EXPECT_NEAR(energy(part.M, q_part) / energy(whole.M, q_whole), 1.0, 1e-12);
}

TEST(Averages, NeedAllComponents)
{
  const mesh::Mesh mesh = testing::small_disc();
  DofMap map = map_of(mesh, {average("pad", "inner_edge")});
  map.components = {2, 3, 4};
  try {
    assemble(mesh, testing::section, std::move(map), PETSC_COMM_WORLD);
    FAIL() << "an average of three components is accepted";
  } catch (const Error& error) {
    expect_words(error.what(), {"averaging", "all six DOFs", "rigid"});
  }
}

}  // namespace
}  // namespace chladni::plate
