#include "cases/described_system.hpp"

#include <algorithm>

namespace chladni::cases {

mbs_export::ReducedSystem described_system(const scene::Scene& scene, const FeModel& fe)
{
  mbs_export::ReducedSystem system;
  system.title = scene.title;
  system.sets = fe.attachments.sets;
  for (std::size_t i = 0; i < fe.attachments.nodes.size(); ++i) {
    const int node = fe.attachments.nodes[i];
    const Eigen::Vector3d x = fe.system.dofs.position(node);
    system.attachment_nodes.push_back({.number = node_number(fe.mesh, fe.system.dofs, node),
                                       .position = {x[0], x[1], x[2]},
                                       .drilling_axis = fe.attachments.drilling_axes[i]});
  }
  system.masters = fe.attachments.masters;
  if (!fe.system.dofs.harmonic_rings().empty()) {
    const Eigen::MatrixXd F = master_shapes(fe.attachments, fe.system.dofs);
    system.ring_motion = {.shapes = F, .displacements = F};  // of the masters alone
  }
  return system;
}

std::vector<std::string> certified_support(const scene::Scene& scene, const FeModel& fe)
{
  std::vector<std::string> support;
  for (const std::string& fixed : scene.body.fixed) {
    const bool is_master = std::ranges::none_of(fe.attachments.sets, [&](const auto& set) {
      const bool is_meant = fixed == set.name || fixed.substr(0, fixed.rfind('.')) == set.name;
      return is_meant && has_ring_nodes(fe.attachments, fe.system.dofs, set);
    });
    if (is_master) support.push_back(fixed);
  }
  return support;
}

}  // namespace chladni::cases
