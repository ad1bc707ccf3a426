#include "mbs_export/drilling.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/error.hpp"
#include "mbs_export/attachment_motion.hpp"
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
  throw Error(fmt::format(
      "interface_modes: {}, so that a moment about it would only turn this node; take {} out of "
      "\"dofs\", {}",
      words_of(reduced, node, component), component_name(component), couple_instead));
}

void refuse_drilling_support(const ReducedSystem& reduced, const HeldDofs& held)
{
  std::vector<int> others;
  int first = -1;
  for (const int dof : held.dofs) {
    const bool is_such = is_drilling(reduced, dof / 6, dof % 6);
    if (!is_such) others.push_back(dof);
    if (is_such && first < 0) first = dof;
  }
  if (first < 0) return;
  const MatrixXd motion = attachment_motion(reduced, rigid_modes(reduced).R);
  const Index n_free = unheld_combinations(motion(held.dofs, Eigen::all)).cols();
  if (unheld_combinations(motion(others, Eigen::all)).cols() == n_free) return;
  throw Error(
      fmt::format("body.fixed: {}, and nothing else holds the body there; hold displacements of "
                  "another node as "
                  "well, {}",
                  words_of(reduced, first / 6, first % 6), couple_instead));
}

}  // namespace chladni::mbs_export
