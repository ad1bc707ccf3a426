#include <fmt/format.h>

#include <optional>
#include <string>

#include "cli/reduce_steps.hpp"

namespace chladni::cli {
namespace {

struct NodeDof {
  int node;
  int component;
};

std::optional<NodeDof> node_of(const plate::DofMap& dofs, PetscInt dof)
{
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    for (const int c : dofs.components) {
      if (dofs.dof(node, c) == dof) return NodeDof{node, c};
    }
  }
  return std::nullopt;
}

/// "; it moves most at node 17 (0.1, 0.2, 0), z"
std::string place_of(const FeModel& fe, PetscInt dof)
{
  const auto place = node_of(fe.system.dofs, dof);
  if (!place) return "";
  const auto& x = fe.system.dofs.positions[static_cast<std::size_t>(place->node)];
  return fmt::format("; it moves most at node {} ({:.6g}, {:.6g}, {:.6g}), {}",
                     node_number(fe.mesh, fe.system.dofs, place->node), x[0], x[1], x[2],
                     plate::component_names[static_cast<std::size_t>(place->component)]);
}

}  // namespace

reduce::Factorization factorize_slaves(const FeModel& fe, const Partitioned& blocks,
                                       const reduce::SolverOptions& options)
{
  try {
    return reduce::factorize(blocks.K.ss, options);
  } catch (const reduce::FreeMotion& free) {
    if (free.row < 0) throw;
    throw Error(free.what() + place_of(fe, reduce::dof_of_slave(blocks.rows, free.row)));
  }
}

}  // namespace chladni::cli
