#include "plate/assembly/assemble.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>
#include <map>
#include <set>

#include "common/all_ranks.hpp"
#include "common/checked_count.hpp"
#include "mesh/element_types.hpp"
#include "plate/assembly/block_rows.hpp"
#include "plate/assembly/element_motion.hpp"
#include "plate/dofs/couplings.hpp"
#include "plate/dofs/drilling.hpp"
#include "plate/dofs/point_elements.hpp"
#include "plate/elements/interpolation.hpp"
#include "plate/elements/solid_element.hpp"
#include "plate/sections/sections.hpp"

namespace chladni::plate {

using Eigen::Index, Eigen::Vector3d;

namespace {

/// Some forty times eps: what bending and membrane of a flat shell have in common after the
/// products and sums of its elements. As entries they would make half as many operations more of a
/// factor.
constexpr double round_off = 1e-14;

/// C of the dampers, whose few entries have a pattern of their own; null without one.
petsc::Matrix damping_matrix(std::span<const PointElement> points, const DofMap& dofs,
                             MPI_Comm comm)
{
  const auto is_damper = [](const PointElement& point) { return point.C.size() > 0; };
  if (std::ranges::none_of(points, is_damper)) return {};
  std::vector<PointElement> dampers;
  std::ranges::copy_if(points, std::back_inserter(dampers), is_damper);
  const BlockPattern pattern = point_pattern(dampers, dofs, petsc::rank(comm));
  BlockRows C(pattern);
  for (const PointElement& damper : dampers) {
    const ElementMotion motion = element_motion(dofs, damper.nodes, {});
    add_symmetric(C, damper.C, motion, dofs, block_places(pattern, motion.numbers));
  }
  return C.to_matrix(comm);
}

/// The nodes of the elements that this rank assembles; empty for all.
NodeMask own_nodes(const mesh::Mesh& mesh, const DofMap& dofs, MPI_Comm comm)
{
  if (petsc::size(comm) == 1) return {};
  NodeMask are_own(std::size_t(mesh.n_nodes()), 0);
  for_owned_elements(mesh, dofs, petsc::rank(comm), [&](const auto& block, int e, const auto&) {
    for (const int node : block.element_nodes(e)) are_own[std::size_t(node)] = 1;
  });
  return are_own;
}

}  // namespace

namespace {

/// Sums of the matrices of a system over one pattern.
struct Sums {
  BlockRows K, M, H, C;

  explicit Sums(const BlockPattern& pattern) : K(pattern), M(pattern), H(pattern), C(pattern) {}
};

void add_elements(const mesh::Mesh& mesh, const Structure& structure, const DofMap& dofs,
                  const BlockPattern& pattern, MPI_Comm comm, Sums& sums)
{
  const SectionMap sections = map_sections(mesh, structure);
  const Directors directors =
      on_all_ranks(comm, [&] { return shell_directors(mesh, own_nodes(mesh, dofs, comm)); });
  const bool is_lossy = has_loss_factors(structure);
  const auto add_element = [&](const mesh::ElementBlock& block, int e, const auto&) {
    const ElementContext context{sections, structure, directors};
    auto [matrices, arms] = element_matrices(mesh, block, e, context);
    const ElementMotion motion = element_motion(dofs, block.element_nodes(e), arms);
    const std::vector<std::ptrdiff_t> places = block_places(pattern, motion.numbers);
    const double eta = is_lossy ? loss_factor(block, e, context) : 0.0;
    if (eta > 0.0) add_symmetric(sums.H, eta * matrices.K, motion, dofs, places);
    add_symmetric(sums.K, std::move(matrices.K), motion, dofs, places);
    add_symmetric(sums.M, std::move(matrices.M), motion, dofs, places);
  };
  on_all_ranks(comm, [&] {
    for_owned_elements(mesh, dofs, petsc::rank(comm), add_element);
    return true;
  });
}

/// Adds the matrices of the mesh.
void add_blocks(const mesh::NodalMatrices& matrices, const DofMap& dofs,
                const BlockPattern& pattern, int rank, Sums& sums)
{
  const auto add = [&](const std::vector<mesh::MatrixEntry>& matrix, BlockRows& sum) {
    for_owned_blocks(matrix, dofs, rank, [&](std::span<const int> nodes, auto entries) {
      const ElementMotion motion = element_motion(dofs, nodes, {});
      add_symmetric(sum, block_matrix(nodes, entries), motion, dofs,
                    block_places(pattern, motion.numbers));
    });
  };
  add(matrices.K, sums.K);
  add(matrices.M, sums.M);
  add(matrices.C, sums.C);
  add(matrices.H, sums.H);
}

void add_points(std::span<const PointElement> points, const DofMap& dofs,
                const BlockPattern& pattern, Sums& sums)
{
  for (const PointElement& point : points) {
    const ElementMotion motion = element_motion(dofs, point.nodes, {});
    const std::vector<std::ptrdiff_t> places = block_places(pattern, motion.numbers);
    if (point.K.size() > 0) add_symmetric(sums.K, point.K, motion, dofs, places);
    if (point.K.size() > 0 && point.loss_factor > 0.0)
      add_symmetric(sums.H, point.loss_factor * point.K, motion, dofs, places);
    if (point.M.size() > 0) add_symmetric(sums.M, point.M, motion, dofs, places);
  }
}

/// DOFs that no motion has are springs and masses by themselves, whose frequency lies far above
/// those of the elements.
void add_unused(const DofMap& dofs, const BlockPattern& pattern, int rank, Sums& sums)
{
  const int n = dofs.n_components();
  for (const int dof : dofs.unused_dofs()) {
    const PetscInt number = dof / n;
    if (number < dofs.first_number(rank) || number >= dofs.first_number(rank + 1)) continue;
    Eigen::MatrixXd one = Eigen::MatrixXd::Zero(n, n);
    one(dof % n, dof % n) = 1.0;
    const std::vector<std::ptrdiff_t> place = block_places(pattern, {&number, 1});
    sums.K.add(one * 1e9, place);
    sums.M.add(one * 1e-12, place);
  }
}

}  // namespace

System assemble(const mesh::Mesh& mesh, const Structure& structure, DofMap dofs, MPI_Comm comm)
{
  checked_count(std::int64_t{dofs.n_active()} * dofs.n_components(), "DOFs", "use a coarser mesh");
  const std::vector<PointElement> points = point_elements(mesh, structure, dofs);
  const BlockPattern pattern = element_pattern(mesh, points, dofs, petsc::rank(comm));
  Sums sums(pattern);
  const mesh::NodalMatrices* const matrices = mesh.matrices.get();
  if (matrices != nullptr)
    add_blocks(*matrices, dofs, pattern, petsc::rank(comm), sums);
  else
    add_elements(mesh, structure, dofs, pattern, comm, sums);
  add_points(points, dofs, pattern, sums);
  add_unused(dofs, pattern, petsc::rank(comm), sums);
  const bool is_lossy =
      has_loss_factors(structure) || (matrices != nullptr && !matrices->H.empty());
  petsc::Matrix C = damping_matrix(points, dofs, comm);
  if (matrices != nullptr && !matrices->C.empty()) {
    petsc::Matrix of_mesh = sums.C.to_symmetric_matrix(comm, 0.0, Rows::as_they_are);
    if (C != nullptr) petsc::check(MatAXPY(of_mesh, 1.0, C, DIFFERENT_NONZERO_PATTERN));
    C = std::move(of_mesh);
  }
  return {.K = sums.K.to_symmetric_matrix(comm, round_off, Rows::alike),
          .M = sums.M.to_symmetric_matrix(comm, round_off, Rows::as_they_are),
          .C = std::move(C),
          .H = is_lossy ? sums.H.to_symmetric_matrix(comm, round_off, Rows::as_they_are)
                        : petsc::Matrix(),
          .dofs = std::move(dofs)};
}

System assemble(const mesh::Mesh& mesh, std::span<const ShellSection> sections, DofMap dofs,
                MPI_Comm comm)
{
  return assemble(mesh, Structure{.shells = sections}, std::move(dofs), comm);
}

Vector3d centre_of_nodes(const DofMap& dofs)
{
  Vector3d sum = Vector3d::Zero();
  for (int node = 0; node < dofs.n_nodes(); ++node) sum += dofs.position(node);
  return sum / static_cast<double>(dofs.n_nodes());
}

petsc::Matrix rigid_motions(const System& system)
{
  const DofMap& dofs = system.dofs;
  assert(!dofs.has_combined_motions());
  petsc::Matrix R;
  PetscInt n_local = 0;
  petsc::check(MatGetLocalSize(system.K, &n_local, nullptr));
  petsc::check(MatCreateDense(petsc::communicator(system.K), n_local, PETSC_DECIDE, PETSC_DETERMINE,
                              6, nullptr, R.put()));
  const Vector3d origin = centre_of_nodes(dofs);
  const int rank = petsc::rank(petsc::communicator(R));
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    const int number = dofs.number(node);
    if (number < dofs.first_number(rank) || number >= dofs.first_number(rank + 1)) continue;
    const Matrix6d motion = rigid_arm(dofs.position(node) - origin);
    for (const int c : dofs.components_of(node)) {
      const int row = *dofs.dof(node, c);
      for (int k = 0; k < 6; ++k) petsc::check(MatSetValue(R, row, k, motion(c, k), INSERT_VALUES));
    }
  }
  petsc::check(MatAssemblyBegin(R, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(R, MAT_FINAL_ASSEMBLY));
  return R;
}

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Adds forces on nodes to the rows of f that this rank owns; every rank adds all forces.
class Forces {
 public:
  explicit Forces(const System& system) : dofs_(system.dofs)
  {
    petsc::check(MatCreateVecs(system.K, nullptr, f_.put()));
    petsc::check(VecGetOwnershipRange(f_, &first_, &last_));
  }

  void add(int node, const Vector6d& force)
  {
    for (const MotionTerm& term : dofs_.motion(node)) {
      const Vector6d share = term.T.transpose() * force;
      for (const int c : dofs_.components()) {
        const int dof = *dofs_.dof_of_number(term.number, c);
        if (dof < first_ || dof >= last_) continue;
        petsc::check(VecSetValue(f_, dof, share[c], ADD_VALUES));
      }
    }
  }
  void add_force(int node, const Vector3d& force)
  {
    Vector6d all = Vector6d::Zero();
    all.head<3>() = force;
    add(node, all);
  }

  const DofMap& dofs() const { return dofs_; }
  petsc::Vector assembled()
  {
    petsc::check(VecAssemblyBegin(f_));
    petsc::check(VecAssemblyEnd(f_));
    return std::move(f_);
  }

 private:
  const DofMap& dofs_;
  petsc::Vector f_;
  PetscInt first_ = 0, last_ = 0;
};

Vector3d vector_of(const std::array<double, 3>& x)
{
  return {x[0], x[1], x[2]};
}

/// Positions of nodes, [n x 3].
Eigen::MatrixX3d positions_of(const mesh::Mesh& mesh, std::span<const int> nodes)
{
  Eigen::MatrixX3d x(std::ssize(nodes), 3);
  for (Index i = 0; i < x.rows(); ++i) x.row(i) = vector_of(mesh.positions[nodes[i]]).transpose();
  return x;
}

void add_load(const mesh::Mesh& mesh, const NodalLoad& load, Forces& forces)
{
  const std::vector<int> nodes = forces.dofs().named_nodes(mesh, load.group);
  if (nodes.empty()) throw Error(fmt::format("load on \"{}\": it has no nodes", load.group));
  const auto cannot_turn = [&](int node) { return !forces.dofs().has_rotations(node); };
  const auto without = std::ranges::find_if(nodes, cannot_turn);
  if (without != nodes.end() && load.moment != std::array<double, 3>{}) {
    throw Error(fmt::format(
        "load on \"{}\": node {} of a solid has no rotations, so that no moment can act there; "
        "give "
        "forces, or couple the group rigidly ([[coupling]]) and take the coupling's name",
        load.group, mesh.node_numbers[*without]));
  }
  Vector6d force;
  force << vector_of(load.force), vector_of(load.moment);
  for (const int node : nodes) forces.add(node, force / static_cast<double>(nodes.size()));
}

/// f_i = int N_i q ds along the edges.
void add_load(const mesh::Mesh& mesh, const EdgeLoad& load, Forces& forces)
{
  const std::map<int, double> shares = edge_shares(mesh, load.group);
  if (shares.empty()) {
    throw Error(fmt::format(
        "line load on \"{}\": no edge of an element has all its nodes in this group", load.group));
  }
  for (const auto& [node, share] : shares)
    forces.add_force(node, share * vector_of(load.line_force));
}

/// f_i = int N_i p (a_1 x a_2) d xi d eta over one surface.
void add_pressure(const mesh::Mesh& mesh, std::span<const int> nodes, const Points& points,
                  const Basis& basis, double p, Forces& forces)
{
  const Eigen::MatrixX3d x = positions_of(mesh, nodes);
  const Eigen::MatrixX3d a_1 = basis.N_xi * x;
  const Eigen::MatrixX3d a_2 = basis.N_eta * x;
  Eigen::MatrixX3d f = Eigen::MatrixX3d::Zero(x.rows(), 3);
  for (Index q = 0; q < points.size(); ++q) {
    const Eigen::RowVector3d area = a_1.row(q).cross(a_2.row(q));
    f += p * points.weight[q] * basis.N.row(q).transpose() * area;
  }
  for (Index i = 0; i < f.rows(); ++i) forces.add_force(nodes[i], f.row(i));
}

void add_load(const mesh::Mesh& mesh, const PressureLoad& load, Forces& forces)
{
  const mesh::Group& group = mesh::find_group(mesh, load.group);
  const auto index = static_cast<int>(&group - mesh.groups.data());
  int n_elements = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (!mesh::is_surface(block.shape)) continue;
    const Points points = gauss_points(block.shape, block.order + 2);
    const Basis basis = lagrange_basis(block.shape, block.order, points);
    for (int e = 0; e < block.n_elements(); ++e) {
      if (block.group[e] != index) continue;
      add_pressure(mesh, block.element_nodes(e), points, basis, load.pressure, forces);
      ++n_elements;
    }
  }
  const std::set<int> members(group.nodes.begin(), group.nodes.end());
  for (const mesh::FreeFace& face : mesh::free_faces(mesh)) {
    if (!std::ranges::all_of(face.nodes, [&](int node) { return members.contains(node); }))
      continue;
    const FaceRule& rule =
        face_rule(static_cast<int>(face.nodes.size()), mesh.blocks[face.block].order);
    add_pressure(mesh, face.nodes, rule.points, rule.basis, -load.pressure, forces);  // inwards
    ++n_elements;
  }
  if (n_elements == 0) {
    throw Error(
        fmt::format("pressure on \"{}\": the group has neither shell elements nor faces of solids",
                    load.group));
  }
}

/// The acceleration as the motion of every node.
petsc::Vector translation(const System& system, const std::array<double, 3>& a)
{
  petsc::Vector motion;
  petsc::check(MatCreateVecs(system.M, motion.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(motion, &first, &last));
  for (int node = 0; node < system.dofs.n_nodes(); ++node) {
    for (int c = 0; c < 3; ++c) {
      const auto dof = system.dofs.dof(node, c);
      if (!dof || *dof < first || *dof >= last) continue;
      petsc::check(VecSetValue(motion, *dof, a[c], INSERT_VALUES));
    }
  }
  petsc::check(VecAssemblyBegin(motion));
  petsc::check(VecAssemblyEnd(motion));
  return motion;
}

}  // namespace

petsc::Vector load_vector(const mesh::Mesh& mesh, const System& system, std::span<const Load> loads)
{
  refuse_drilling(mesh, system.dofs, loads);
  Forces forces(system);
  for (const Load& load : loads) {
    if (std::holds_alternative<GravityLoad>(load)) continue;
    if (const auto* nodal = std::get_if<NodalLoad>(&load)) add_load(mesh, *nodal, forces);
    if (const auto* edge = std::get_if<EdgeLoad>(&load)) add_load(mesh, *edge, forces);
    if (const auto* p = std::get_if<PressureLoad>(&load)) add_load(mesh, *p, forces);
  }
  petsc::Vector f = forces.assembled();
  for (const Load& load : loads) {
    const auto* gravity = std::get_if<GravityLoad>(&load);
    if (!gravity) continue;
    const petsc::Vector a = translation(system, gravity->acceleration);
    petsc::check(MatMultAdd(system.M, a, f, f));
  }
  return f;
}

}  // namespace chladni::plate
