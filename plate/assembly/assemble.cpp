#include "plate/assembly/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/all_ranks.hpp"
#include "common/checked_count.hpp"
#include "plate/assembly/block_rows.hpp"
#include "plate/assembly/element_motion.hpp"
#include "plate/dofs/point_elements.hpp"
#include "plate/sections/directors.hpp"
#include "plate/sections/section_map.hpp"

namespace chladni::plate {

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

System assemble(const mesh::Mesh& mesh, const Structure& structure, DofMap dofs, MPI_Comm comm)
{
  const int rank = petsc::rank(comm);
  checked_count(std::int64_t{dofs.n_active()} * dofs.n_components(), "DOFs", "use a coarser mesh");
  const SectionMap sections = map_sections(mesh, structure);
  const std::vector<PointElement> points = point_elements(mesh, structure, dofs);
  const Directors directors =
      on_all_ranks(comm, [&] { return shell_directors(mesh, own_nodes(mesh, dofs, comm)); });
  const BlockPattern pattern = element_pattern(mesh, points, dofs, rank);
  const bool is_lossy = has_loss_factors(structure);
  BlockRows K(pattern), M(pattern), H(pattern);
  const auto add_element = [&](const mesh::ElementBlock& block, int e, const auto&) {
    const ElementContext context{sections, structure, directors};
    auto [matrices, arms] = element_matrices(mesh, block, e, context);
    const ElementMotion motion = element_motion(dofs, block.element_nodes(e), arms);
    const std::vector<std::ptrdiff_t> places = block_places(pattern, motion.numbers);
    const double eta = is_lossy ? loss_factor(block, e, context) : 0.0;
    if (eta > 0.0) add_symmetric(H, eta * matrices.K, motion, dofs, places);
    add_symmetric(K, std::move(matrices.K), motion, dofs, places);
    add_symmetric(M, std::move(matrices.M), motion, dofs, places);
  };
  on_all_ranks(comm, [&] {
    for_owned_elements(mesh, dofs, rank, add_element);
    return true;
  });
  for (const PointElement& point : points) {
    const ElementMotion motion = element_motion(dofs, point.nodes, {});
    const std::vector<std::ptrdiff_t> places = block_places(pattern, motion.numbers);
    if (point.K.size() > 0) add_symmetric(K, point.K, motion, dofs, places);
    if (point.K.size() > 0 && point.loss_factor > 0.0)
      add_symmetric(H, point.loss_factor * point.K, motion, dofs, places);
    if (point.M.size() > 0) add_symmetric(M, point.M, motion, dofs, places);
  }
  return {
      .K = K.to_symmetric_matrix(comm, round_off, Rows::alike),
      .M = M.to_symmetric_matrix(comm, round_off, Rows::as_they_are),
      .C = damping_matrix(points, dofs, comm),
      .H = is_lossy ? H.to_symmetric_matrix(comm, round_off, Rows::as_they_are) : petsc::Matrix(),
      .dofs = std::move(dofs)};
}

System assemble(const mesh::Mesh& mesh, std::span<const ShellSection> sections, DofMap dofs,
                MPI_Comm comm)
{
  return assemble(mesh, Structure{.shells = sections}, std::move(dofs), comm);
}

}  // namespace chladni::plate
