#include "plate/assembly/element_energies.hpp"

#include "plate/dofs/average_motions.hpp"
#include "plate/sections/directors.hpp"
#include "plate/sections/section_map.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

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
