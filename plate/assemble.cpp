#include "plate/assemble.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "plate/block_rows.hpp"
#include "plate/directors.hpp"
#include "plate/shell_element.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Calls visit(block, element) for each element with a node that `first <= number < last` owns.
template <typename Visit>
void for_owned_elements(const mesh::Mesh& mesh, const DofMap& dofs, int rank, const Visit& visit)
{
  const int first = dofs.range[rank];
  const int last = dofs.range[rank + 1];
  const auto owned = [&](int node) {
    return dofs.number[node] >= first && dofs.number[node] < last;
  };
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      if (std::ranges::any_of(block.element_nodes(e), owned)) visit(block, e);
    }
  }
}

std::vector<PetscInt> active_numbers(const DofMap& dofs, std::span<const int> nodes)
{
  std::vector<PetscInt> numbers;
  for (const int node : nodes) numbers.push_back(dofs.number[node]);
  return numbers;
}

BlockPattern pattern_of(const mesh::Mesh& mesh, const DofMap& dofs, int rank)
{
  const int first = dofs.range[rank];
  const int last = dofs.range[rank + 1];
  std::vector<std::vector<PetscInt>> neighbours(last - first);
  for_owned_elements(mesh, dofs, rank, [&](const mesh::ElementBlock& block, int e) {
    const std::vector<PetscInt> numbers = active_numbers(dofs, block.element_nodes(e));
    for (const PetscInt row : numbers) {
      if (row < first || row >= last) continue;
      auto& list = neighbours[row - first];
      list.insert(list.end(), numbers.begin(), numbers.end());
    }
  });
  return block_pattern(first, std::move(neighbours));
}

/// A_e <- T_e^T A_e T_e with u = u_ref + theta_ref x arm, theta = theta_ref of dependent nodes.
MatrixXd eliminate_dependents(MatrixXd A_e, const DofMap& dofs, std::span<const int> nodes)
{
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!dofs.is_dependent(nodes[i])) continue;
    const auto [x, y, z] = dofs.arm(nodes[i]);
    Eigen::Matrix3d R;  // theta x arm = R theta
    R << 0.0, z, -y, -z, 0.0, x, y, -x, 0.0;
    const auto u = static_cast<Index>(6 * i);
    A_e.middleCols<3>(u + 3) += A_e.middleCols<3>(u) * R;
    A_e.middleRows<3>(u + 3) += R.transpose() * A_e.middleRows<3>(u);
  }
  return A_e;
}

/// Index into `sections` of each group of the mesh, -1 where there is none.
std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const ShellSection> sections)
{
  std::vector<int> section(mesh.groups.size(), -1);
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const mesh::Group& group = mesh::find_group(mesh, sections[s].group);
    const auto index = static_cast<std::size_t>(&group - mesh.groups.data());
    const auto in_group = [&](const mesh::ElementBlock& block) {
      return std::ranges::count(block.group, static_cast<int>(index)) > 0;
    };
    if (std::ranges::none_of(mesh.blocks, in_group)) {
      throw Error(
          fmt::format("section of group \"{}\": the group has no shell elements", group.name));
    }
    section[index] = static_cast<int>(s);
  }
  return section;
}

const ShellSection& section_of(std::span<const ShellSection> sections,
                               const std::vector<int>& of_group, const mesh::ElementBlock& block,
                               int element)
{
  const int group = block.group[element];
  if (group < 0 || of_group[group] < 0) {
    throw Error(fmt::format("element {} has no section: name its physical group in a [[section]]",
                            block.numbers[element]));
  }
  return sections[of_group[group]];
}

/// Checked before the parallel work, on the whole mesh: every rank throws or none.
void check_sections(const mesh::Mesh& mesh, std::span<const ShellSection> sections,
                    const std::vector<int>& of_group)
{
  for (const mesh::ElementBlock& block : mesh.blocks) {
    check_element_exists(block.shape, block.order);
    for (int e = 0; e < block.n_elements(); ++e) section_of(sections, of_group, block, e);
  }
}

}  // namespace

System assemble(const mesh::Mesh& mesh, std::span<const ShellSection> sections, DofMap dofs,
                MPI_Comm comm)
{
  const int rank = petsc::rank(comm);
  const std::vector<int> of_group = section_of_group(mesh, sections);
  check_sections(mesh, sections, of_group);
  const NodeVectors normals = mean_normals(mesh);
  const BlockPattern pattern = pattern_of(mesh, dofs, rank);
  BlockRows K(pattern), M(pattern);
  for_owned_elements(mesh, dofs, rank, [&](const mesh::ElementBlock& block, int e) {
    const ShellSection& section = section_of(sections, of_group, block, e);
    ElementMatrices matrices =
        shell_matrices(block.shape, block.order,
                       shell_nodes(mesh, block, e, normals, section.thickness), section.material);
    const std::span<const int> nodes = block.element_nodes(e);
    const std::vector<PetscInt> numbers = active_numbers(dofs, nodes);
    K.add(eliminate_dependents(std::move(matrices.K), dofs, nodes), numbers);
    M.add(eliminate_dependents(std::move(matrices.M), dofs, nodes), numbers);
  });
  System system{.K = K.to_matrix(comm), .M = M.to_matrix(comm), .dofs = {}};
  system.dofs = std::move(dofs);
  return system;
}

}  // namespace chladni::plate
