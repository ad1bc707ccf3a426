#include "plate/assembly/recovery.hpp"

#include "plate/dofs/couplings.hpp"
#include "plate/elements/solid_element.hpp"
#include "plate/sections/sections.hpp"

namespace chladni::plate {

using Eigen::Index, Eigen::MatrixXd;

namespace {

/// All entries of a distributed vector, on every rank.
Eigen::VectorXd replicate(Vec q)
{
  VecScatter scatter = nullptr;
  petsc::Vector all;
  petsc::check(VecScatterCreateToAll(q, &scatter, all.put()));
  petsc::check(VecScatterBegin(scatter, q, all, INSERT_VALUES, SCATTER_FORWARD));
  petsc::check(VecScatterEnd(scatter, q, all, INSERT_VALUES, SCATTER_FORWARD));
  petsc::check(VecScatterDestroy(&scatter));
  PetscInt n = 0;
  const PetscScalar* values = nullptr;
  petsc::check(VecGetSize(all, &n));
  petsc::check(VecGetArrayRead(all, &values));
  Eigen::VectorXd copy = Eigen::Map<const Eigen::VectorXd>(values, n);
  petsc::check(VecRestoreArrayRead(all, &values));
  return copy;
}

/// One element of a mesh with its section.
struct ShellOfMesh {
  const mesh::Mesh& mesh;
  const mesh::ElementBlock& block;
  int element;
  const ShellSection& section;
};

/// Section forces of one element at its `resultant_points`.
ShellResultants element_resultants(const ShellOfMesh& shell, const Directors& directors,
                                   const MatrixXd& motions)
{
  const auto& [mesh, block, element, section] = shell;
  const ShellNodes shell_at = shell_nodes(mesh, block, element, directors, section);
  const std::span<const int> nodes = block.element_nodes(element);
  Eigen::VectorXd u_e(6 * std::ssize(nodes));
  for (Eigen::Index i = 0; i < std::ssize(nodes); ++i) {
    const auto& [x, y, z] = mesh.positions[nodes[i]];
    const Eigen::Vector3d arm = shell_at.x.row(i).transpose() - Eigen::Vector3d(x, y, z);
    u_e.segment<6>(6 * i) = rigid_arm(arm) * motions.row(nodes[i]).transpose();
  }
  return shell_resultants(block.shape, block.order, shell_at, section.material, u_e);
}

/// Sums over the elements at each node, and how many they are.
struct NodalSums {
  MatrixXd values;  ///< [n_nodes x 17] N, M, Q, the elements and their sides of the normal
};

/// A direction at each node by which the elements of a group are told to have one side or the
/// other.
NodeVectors sides_of(const mesh::Mesh& mesh, int group, const Directors& directors)
{
  NodeVectors sides = directors.common;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const mesh::ElementBlock& block = mesh.blocks[b];
    const auto& own = directors.own[b];
    const auto n = static_cast<std::size_t>(block.nodes_per_element);
    for (std::size_t slot = 0; slot < block.nodes.size() && !own.empty(); ++slot) {
      const auto found = own.find(slot);
      if (found == own.end() || block.group[slot / n] != group) continue;
      auto sum = sides.row(block.nodes[slot]);
      sum += (sum.dot(found->second) < 0.0 ? -1.0 : 1.0) * found->second;
    }
  }
  return sides;
}

/// Directors of a mesh, and the sides of the elements of a group.
struct Orientation {
  Directors directors;
  NodeVectors sides;  ///< `sides_of` the group
};

/// Adds the extrapolated section forces of one element.
void add_element(const ShellOfMesh& shell, const Orientation& orientation, const MatrixXd& motions,
                 NodalSums& sums)
{
  const ShellResultants at_points = element_resultants(shell, orientation.directors, motions);
  const MatrixXd E = extrapolation_to_nodes(shell.block.shape, shell.block.order);
  const MatrixXd N = E * at_points.N, M = E * at_points.M, Q = E * at_points.Q;
  const NodeVectors D =
      shell_nodes(shell.mesh, shell.block, shell.element, orientation.directors, shell.section).D;
  const std::span<const int> nodes = shell.block.element_nodes(shell.element);
  for (Eigen::Index i = 0; i < E.rows(); ++i) {
    const double side = D.row(i).dot(orientation.sides.row(nodes[i])) < 0.0 ? -1.0 : 1.0;
    sums.values.row(nodes[i]).segment<6>(0) += N.row(i);
    sums.values.row(nodes[i]).segment<6>(6) += side * M.row(i);
    sums.values.row(nodes[i]).segment<3>(12) += side * Q.row(i);
    sums.values(nodes[i], 15) += 1.0;
    sums.values(nodes[i], 16) += side;
  }
}

}  // namespace

MatrixXd node_motions(const DofMap& dofs, Vec q)
{
  const Eigen::VectorXd all = replicate(q);
  MatrixXd motions = MatrixXd::Zero(dofs.n_nodes(), 6);
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    for (const MotionTerm& term : dofs.motion(node))
      for (const int c : dofs.components())
        motions.row(node) += all[*dofs.dof_of_number(term.number, c)] * term.T.col(c).transpose();
  }
  return motions;
}

MatrixXd reactions(const DofMap& dofs, const std::vector<int>& held, Vec residual)
{
  const Eigen::VectorXd all = replicate(residual);
  MatrixXd forces = MatrixXd::Zero(dofs.n_nodes(), 6);
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    for (int c = 0; c < 6; ++c) {
      const auto dof = dofs.dof(node, c);
      if (dof && std::ranges::binary_search(held, *dof)) forces(node, c) = all[*dof];
    }
  }
  return forces;
}

ShellResultants nodal_resultants(const mesh::Mesh& mesh, const ShellSection& section,
                                 const MatrixXd& motions, MPI_Comm comm)
{
  const mesh::Group& group = mesh::find_group(mesh, section.group);
  const auto index = static_cast<int>(&group - mesh.groups.data());
  Directors directors = shell_directors(mesh);
  NodeVectors sides = sides_of(mesh, index, directors);
  const Orientation orientation{.directors = std::move(directors), .sides = std::move(sides)};
  NodalSums sums{.values = MatrixXd::Zero(mesh.n_nodes(), 17)};
  const int rank = petsc::rank(comm), n_ranks = petsc::size(comm);
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (!mesh::is_surface(block.shape)) continue;
    for (int e = rank; e < block.n_elements(); e += n_ranks) {
      if (block.group[e] != index) continue;
      add_element({mesh, block, e, section}, orientation, motions, sums);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.values.data(), static_cast<int>(sums.values.size()), MPI_DOUBLE,
                MPI_SUM, comm);
  const Eigen::VectorXd share = sums.values.col(15).cwiseMax(1.0).cwiseInverse();
  const Eigen::VectorXd of_most = (sums.values.col(16).array() < 0.0).select(-share, share);
  return {.N = share.asDiagonal() * sums.values.middleCols<6>(0),
          .M = of_most.asDiagonal() * sums.values.middleCols<6>(6),
          .Q = of_most.asDiagonal() * sums.values.middleCols<3>(12)};
}

namespace {

/// The motions of an element's DOFs.
/// @param arms  [n_e x 3] m, from the nodes of the mesh to the DOFs; empty for zero
/// @return [6 n_e x k]
MatrixXd element_motions(std::span<const int> nodes, const NodeVectors& arms,
                         const MatrixXd& motions)
{
  MatrixXd U_e(6 * std::ssize(nodes), motions.cols());
  for (Index i = 0; i < std::ssize(nodes); ++i) {
    const auto of_node = motions.middleRows<6>(6 * Index{nodes[static_cast<std::size_t>(i)]});
    if (arms.size() == 0)
      U_e.middleRows<6>(6 * i) = of_node;
    else
      U_e.middleRows<6>(6 * i) = rigid_arm(arms.row(i).transpose()) * of_node;
  }
  return U_e;
}

}  // namespace

MatrixXd nodal_stresses(const mesh::Mesh& mesh, const SolidSection& section,
                        const MatrixXd& motions, MPI_Comm comm)
{
  const auto index = static_cast<int>(&mesh::find_group(mesh, section.group) - mesh.groups.data());
  MatrixXd sums = MatrixXd::Zero(mesh.n_nodes(), 7);  // and how many elements
  const int rank = petsc::rank(comm), n_ranks = petsc::size(comm);
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (!mesh::is_solid(block.shape)) continue;
    const MatrixXd E = stresses_to_nodes(block.shape, block.order);
    for (int e = rank; e < block.n_elements(); e += n_ranks) {
      if (block.group[std::size_t(e)] != index) continue;
      const std::span<const int> nodes = block.element_nodes(e);
      const SolidStresses at_points = solid_stresses(
          block.shape, block.order, element_positions(mesh, block, e), section.material);
      Eigen::VectorXd u_e(6 * std::ssize(nodes));
      for (Index i = 0; i < std::ssize(nodes); ++i)
        u_e.segment<6>(6 * i) = motions.row(nodes[std::size_t(i)]).transpose();
      const Eigen::VectorXd sigma = at_points.S * u_e;
      const MatrixXd of_nodes = E * sigma.reshaped(6, E.cols()).transpose();
      for (Index i = 0; i < of_nodes.rows(); ++i) {
        sums.row(nodes[std::size_t(i)]).head<6>() += of_nodes.row(i);
        sums(nodes[std::size_t(i)], 6) += 1.0;
      }
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM,
                comm);
  return sums.col(6).cwiseMax(1.0).cwiseInverse().asDiagonal() * sums.leftCols<6>();
}

MatrixXd element_energies(const mesh::Mesh& mesh, const Structure& structure,
                          const MatrixXd& motions, MPI_Comm comm)
{
  const SectionMap sections = map_sections(mesh, structure);
  const Directors directors = shell_directors(mesh);
  const ElementContext context{sections, structure, directors};
  Index n_elements = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) n_elements += block.n_elements();
  MatrixXd energies = MatrixXd::Zero(n_elements, motions.cols());
  const int rank = petsc::rank(comm), n_ranks = petsc::size(comm);
  Index first = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = rank; e < block.n_elements(); e += n_ranks) {
      const auto [matrices, arms] = element_matrices(mesh, block, e, context);
      const MatrixXd U_e = element_motions(block.element_nodes(e), arms, motions);
      energies.row(first + e) = 0.5 * U_e.cwiseProduct(matrices.K * U_e).colwise().sum();
    }
    first += block.n_elements();
  }
  MPI_Allreduce(MPI_IN_PLACE, energies.data(), static_cast<int>(energies.size()), MPI_DOUBLE,
                MPI_SUM, comm);
  return energies;
}

}  // namespace chladni::plate
