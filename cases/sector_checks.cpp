#include "cases/sector_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "mesh/sectors.hpp"

namespace chladni::cases {

using Eigen::Vector3d;

namespace {

bool is_on_cut(const SectorModel& model, int node)
{
  return std::ranges::any_of(model.mesh.sectors.pairs,
                             [&](const auto& pair) { return pair[0] == node || pair[1] == node; });
}

void refuse_unclosed_components(const std::vector<int>& components)
{
  for (const int c : {0, 1, 3, 4}) {
    const int partner = c % 3 == 0 ? c + 1 : c - 1;
    const auto has = [&](int k) { return std::ranges::find(components, k) != components.end(); };
    if (has(c) == has(partner)) continue;
    throw Error(fmt::format(
        "sectors: nodes with {} but without {} do not turn with the sectors; take both or neither "
        "in model.dofs",
        plate::component_names[std::size_t(c)], plate::component_names[std::size_t(partner)]));
  }
}

void check_mean(const scene::Scene& scene, const SectorModel& model,
                const plate::Coupling& coupling)
{
  if (std::ranges::count(scene.interface_nodes, coupling.name) > 0) {
    throw Error(fmt::format(
        "sectors: \"{}\" is the mean of a group, which is no interface node of a sector; mesh the "
        "whole body, or take it out of interface.nodes",
        coupling.name));
  }
  for (const int node : mesh::find_group(model.mesh, coupling.group).nodes) {
    if (!is_on_cut(model, node) && !is_on_axis(model, node)) continue;
    throw Error(fmt::format(
        "sectors: the group of the mean \"{}\" has node {} on a cut edge or on the axis, which "
        "several sectors share; cut the body elsewhere, or mesh all of it",
        coupling.name, model.mesh.node_numbers[std::size_t(node)]));
  }
}

}  // namespace

bool turns_with_sectors(const plate::PointMass& mass)
{
  const auto& I = mass.inertia;
  return I[0] == I[1] && I[3] == 0.0 && I[4] == 0.0 && I[5] == 0.0 && mass.offset[0] == 0.0 &&
         mass.offset[1] == 0.0;
}

bool turns_with_sectors(const plate::Spring& spring)
{
  const auto is_same_across = [](const std::array<double, 6>& values) {
    return values[0] == values[1] && values[3] == values[4];
  };
  return is_same_across(spring.stiffness) && is_same_across(spring.damping);
}

bool is_on_axis(const SectorModel& model, int node)
{
  const Vector3d x = model.system.dofs.position(node);
  return mesh::is_on_axis({x[0], x[1], x[2]}, mesh::outer_radius(model.mesh));
}

void refuse_unsupported(const scene::Scene& scene)
{
  const auto refuse = [](const char* what) {
    throw Error(fmt::format("sectors: {}; mesh the whole body, or take this out", what));
  };
  refuse_unclosed_components(scene.components);
  for (const auto& interface : scene.body.interface_modes)
    if (interface.space == mbs_export::InterfaceModes::Space::full)
      refuse("interface modes with space = \"full\" are not available for one sector");
}

void check_means(const scene::Scene& scene, const SectorModel& model)
{
  for (const plate::Coupling& coupling : scene.couplings)
    if (coupling.kind == plate::CouplingKind::averaging) check_mean(scene, model, coupling);
}

namespace {

void refuse_cut_edge(const SectorModel& model, const std::string& what, const std::string& name)
{
  for (const int node : model.system.dofs.named_nodes(model.mesh, name)) {
    if (!is_on_cut(model, node)) continue;
    throw Error(fmt::format(
        "sectors: the deviating {} at \"{}\" stands on a cut edge, which two sectors share; cut "
        "the body elsewhere",
        what, name));
  }
}

void refuse_axis(const SectorModel& model, const std::string& what, const std::string& name)
{
  for (const int node : model.system.dofs.named_nodes(model.mesh, name)) {
    if (!is_on_axis(model, node)) continue;
    throw Error(
        fmt::format("sectors: the deviating {0} at \"{1}\" stands on the axis, in no sector; give "
                    "it as [[{0}]]",
                    what, name));
  }
}

}  // namespace

void check_deviations(const scene::Scene& scene, const SectorModel& model)
{
  if (!scene.deviations.empty() && scene.reduce.method == reduce::Method::macneal) {
    throw Error(
        "sectors: modes after MacNeal have no mass of their own to which deviations could be "
        "added; "
        "take the method \"rubin\"");
  }
  for (const scene::Deviation& deviation : scene.deviations) {
    const auto check = [&](const std::string& what, const std::string& at) {
      refuse_cut_edge(model, what, at);
      refuse_axis(model, what, at);
    };
    if (deviation.mass) check("mass", deviation.mass->at);
    if (deviation.spring) check("spring", deviation.spring->at);
    if (deviation.spring && deviation.spring->to)
      refuse_cut_edge(model, "spring", *deviation.spring->to);
    if (!deviation.section) continue;
    if (std::ranges::count(scene.resultants.groups, deviation.section->group) == 0) continue;
    throw Error(fmt::format(
        "sectors: section forces of \"{}\", whose section deviates in some sectors, are not "
        "available; mesh the whole body, or take it out of reduce.resultants",
        deviation.section->group));
  }
}

void check_ring(const SectorModel& model, const std::string& name,
                std::span<const SectorNode> nodes, const cyclic::Ring& ring)
{
  constexpr double placement = 1e-6;
  const Vector3d first = model.system.dofs.position(nodes.front().node);
  const double radius = first.head<2>().norm(), step = 2.0 * std::numbers::pi / ring.n_nodes;
  for (const SectorNode& node : nodes) {
    const Vector3d x = model.system.dofs.position(node.node);
    const double steps = (node.angle - nodes.front().angle) / step;
    if (std::abs(x.head<2>().norm() - radius) < placement * radius &&
        std::abs(x.z() - first.z()) < placement * radius &&
        std::abs(steps - std::round(steps)) * step < placement)
      continue;
    throw Error(fmt::format(
        "sectors: the nodes of \"{}\" are not equally spaced on one circle of the whole body, as "
        "its harmonics need them ({} in each sector); make it by mesh.rings, or give each circle a "
        "name of its own",
        name, nodes.size()));
  }
}

}  // namespace chladni::cases
