#include "cases/attachments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "common/error.hpp"
#include "plate/dofs/drilling.hpp"

namespace chladni::cases {
namespace {

using Eigen::Index, Eigen::MatrixXd;

bool is_of_ring(const plate::DofMap& dofs, int node)
{
  return std::ranges::any_of(dofs.harmonic_rings(), [&](const plate::HarmonicRing& ring) {
    return std::ranges::find(ring.nodes, node) != ring.nodes.end();
  });
}

void add_node_masters(Attachments& attachments, const plate::DofMap& dofs)
{
  for (int i = 0; i < std::ssize(attachments.nodes); ++i) {
    const int node = attachments.nodes[static_cast<std::size_t>(i)];
    if (is_of_ring(dofs, node)) continue;
    for (const int c : dofs.components()) {
      attachments.masters.push_back({.node = i, .component = c});
      attachments.master_dofs.push_back(dofs.dof(node, c).value());
    }
  }
}

void add_ring_masters(Attachments& attachments, const plate::DofMap& dofs)
{
  for (const plate::HarmonicRing& ring : dofs.harmonic_rings()) {
    const auto set =
        std::ranges::find(attachments.sets, ring.name, &mbs_export::AttachmentSet::name);
    for (int k = 0; k < ring.n_wanted(); ++k) {
      const plate::Harmonic harmonic = plate::harmonic_of(k);
      for (const int c : dofs.components()) {
        attachments.masters.push_back({.node = -1,
                                       .component = c,
                                       .harmonic = mbs_export::RingHarmonic{
                                           .set = static_cast<int>(set - attachments.sets.begin()),
                                           .order = harmonic.order,
                                           .is_sine = harmonic.is_sine}});
        attachments.master_dofs.push_back(
            dofs.dof_of_number(ring.numbers[static_cast<std::size_t>(k)], c).value());
      }
    }
  }
}

void check_independent(const mesh::Mesh& mesh, const plate::DofMap& dofs, const std::string& name,
                       int node)
{
  for (const int component : dofs.components()) {
    if (dofs.dof(node, component) || is_of_ring(dofs, node)) continue;
    const std::string& followed = dofs.followed(node);
    throw Error(
        fmt::format("interface node set \"{}\": node {} follows \"{}\"; put \"{}\" into "
                    "interface.nodes instead",
                    name, mesh.node_numbers[node], followed, followed));
  }
}

}  // namespace

std::int64_t node_number(const mesh::Mesh& mesh, const plate::DofMap& dofs, int node)
{
  if (node < dofs.n_mesh_nodes()) return mesh.node_numbers[node];
  return mesh.node_numbers.back() + 1 + node - dofs.n_mesh_nodes();
}

Attachments find_attachments(const mesh::Mesh& mesh, const plate::DofMap& dofs,
                             const std::vector<std::string>& names)
{
  Attachments attachments;
  for (const std::string& name : names) {
    mbs_export::AttachmentSet set{.name = name, .nodes = {}};
    for (const int node : dofs.named_nodes(mesh, name)) {
      check_independent(mesh, dofs, name, node);
      const auto it = std::ranges::find(attachments.nodes, node);
      set.nodes.push_back(static_cast<int>(it - attachments.nodes.begin()));
      if (it == attachments.nodes.end()) attachments.nodes.push_back(node);
    }
    attachments.sets.push_back(std::move(set));
  }
  add_node_masters(attachments, dofs);
  add_ring_masters(attachments, dofs);
  const Eigen::MatrixX3d axes = plate::drilling_axes(mesh, dofs, attachments.nodes);
  for (Index i = 0; i < axes.rows(); ++i) attachments.drilling_axes.push_back(axes.row(i));
  return attachments;
}

bool has_ring_nodes(const Attachments& attachments, const plate::DofMap& dofs,
                    const mbs_export::AttachmentSet& set)
{
  return std::ranges::any_of(set.nodes, [&](int node) {
    return is_of_ring(dofs, attachments.nodes[static_cast<std::size_t>(node)]);
  });
}

MatrixXd master_shapes(const Attachments& attachments, const plate::DofMap& dofs)
{
  std::map<int, Index> column_of;
  for (const int dof : attachments.master_dofs) column_of.emplace(dof, std::ssize(column_of));
  MatrixXd F = MatrixXd::Zero(6 * std::ssize(attachments.nodes), std::ssize(column_of));
  for (Index i = 0; i < std::ssize(attachments.nodes); ++i) {
    for (const plate::MotionTerm& term :
         dofs.motion(attachments.nodes[static_cast<std::size_t>(i)])) {
      for (const int c : dofs.components()) {
        const auto found = column_of.find(dofs.dof_of_number(term.number, c).value());
        if (found != column_of.end()) F.block<6, 1>(6 * i, found->second) += term.T.col(c);
      }
    }
  }
  return F;
}

}  // namespace chladni::cases
