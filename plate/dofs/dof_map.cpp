#include "plate/dofs/dof_map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"

namespace chladni::plate {

namespace {

/// The DOFs of averages and harmonics stand in those of a group, whatever component these are.
void check_components(const Kinematics& kinematics)
{
  if (kinematics.components.size() == 6) return;
  if (!kinematics.rings.empty()) {
    throw Error(fmt::format("ring \"{}\": harmonics need all six DOFs of each node",
                            kinematics.rings.front().ring));
  }
  if (std::ranges::count(kinematics.couplings, CouplingKind::averaging, &Coupling::kind) == 0)
    return;
  throw Error(
      "an averaging coupling needs all six DOFs of each node; use a rigid one, or all six DOFs");
}

}  // namespace

const std::array<const char*, 6> component_names{"x", "y", "z", "rx", "ry", "rz"};

std::optional<int> DofMap::dof_of_number(int active, int component) const
{
  const auto it = std::ranges::find(components_, component);
  if (it == components_.end()) return std::nullopt;
  return n_components() * active + static_cast<int>(it - components_.begin());
}

std::optional<int> DofMap::dof(int node, int component) const
{
  if (is_dependent(node)) return std::nullopt;
  const auto it = combined.find(node);
  if (it == combined.end()) return dof_of_number(number(node), component);
  const int dof = it->second.dof[static_cast<std::size_t>(component)];
  return dof < 0 ? std::nullopt : std::optional(dof);
}

DofMap make_dof_map(const mesh::Mesh& mesh, const Kinematics& kinematics,
                    std::span<const int> owners, int n_ranks)
{
  const std::span<const Coupling> couplings = kinematics.couplings;
  CoupledNodes coupled = follow_references(mesh, couplings);
  NumberedNodes numbered = number_nodes(std::move(coupled), couplings, owners, n_ranks);
  NodeMotions averaged = average_motions(mesh, couplings, std::move(numbered));
  check_components(kinematics);
  return {with_ring_harmonics(mesh, std::move(averaged), kinematics.rings), kinematics.components};
}

}  // namespace chladni::plate
