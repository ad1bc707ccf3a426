#include "mbs_export/drilling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "common/eigen_every.hpp"
#include "mbs_export/attachment_motion.hpp"
#include "mbs_export/body_option_error.hpp"
#include "mbs_export/mode_shift.hpp"
#include "mbs_export/orthogonalize.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd;

/// `node 17 belongs to ... by a numerical stiffness alone`
std::string words_of(const ReducedSystem& reduced, int node, int component)
{
  const AttachmentNode& at = reduced.attachment_nodes[static_cast<std::size_t>(node)];
  return fmt::format(
      "node {} belongs to a smooth shell, whose elements resist the rotation {} about its normal "
      "by a numerical stiffness alone",
      at.number, component_name(component));
}

constexpr const char* couple_instead =
    "or couple a group of nodes rigidly ([[coupling]], type \"rigid\") and take the coupling's "
    "name";

/// What the held DOFs show of each held node's rotation about its own drilling axis, in which it
/// may go along with the body as if it were not held; of the size of the axis.
MatrixXd drilling_spins(const ReducedSystem& reduced, const HeldDofs& held)
{
  const auto n = static_cast<Index>(held.dofs.size());
  std::map<int, Eigen::VectorXd> spins;
  for (Index i = 0; i < n; ++i) {
    const int dof = held.dofs[static_cast<std::size_t>(i)];
    if (!is_drilling(reduced, dof / 6, dof % 6)) continue;
    const auto& axis = reduced.attachment_nodes[static_cast<std::size_t>(dof / 6)].drilling_axis;
    Eigen::VectorXd& spin = spins.try_emplace(dof / 6, Eigen::VectorXd::Zero(n)).first->second;
    spin[i] = axis[dof % 6 - 3];
  }
  MatrixXd columns(n, std::ssize(spins));
  Index j = 0;
  for (const auto& [node, spin] : spins) columns.col(j++) = spin;
  return columns;
}

}  // namespace

bool is_drilling(const ReducedSystem& reduced, int node, int component)
{
  constexpr double tilt = 1e-2;  // rad: normals of a mesh of a curved shell are as exact as that
  if (component < 3) return false;
  const AttachmentNode& at = reduced.attachment_nodes[static_cast<std::size_t>(node)];
  return std::abs(at.drilling_axis[component - 3]) > tilt;
}

void refuse_drilling_load(const ReducedSystem& reduced, int node, int component)
{
  if (!is_drilling(reduced, node, component)) return;
  throw BodyOptionError(
      "interface_modes",
      fmt::format("{}, so that a moment about it would only turn this node; take {} out of "
                  "\"dofs\", {}",
                  words_of(reduced, node, component), component_name(component), couple_instead));
}

void refuse_drilling_support(const ReducedSystem& reduced, const HeldDofs& held)
{
  const auto first = std::ranges::find_if(
      held.dofs, [&](int dof) { return is_drilling(reduced, dof / 6, dof % 6); });
  if (first == held.dofs.end()) return;
  const MatrixXd motion = attachment_motion(reduced, rigid_modes(reduced).R)(held.dofs, every);
  const MatrixXd spins = drilling_spins(reduced, held);
  MatrixXd both(motion.rows(), motion.cols() + spins.cols());
  both << motion, spins;
  const Index n_free = unheld_combinations(motion).cols();
  if (unheld_combinations(both).cols() == n_free) return;
  throw BodyOptionError(
      "fixed", fmt::format("{}, and nothing else holds the body there; hold displacements of "
                           "another node as "
                           "well, {}",
                           words_of(reduced, *first / 6, *first % 6), couple_instead));
}

}  // namespace chladni::mbs_export
