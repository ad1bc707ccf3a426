#include "cases/sector_model.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cases/fe_model.hpp"
#include "common/error.hpp"
#include "mesh/sectors.hpp"
#include "plate/dofs/drilling.hpp"
#include "reduce/cyclic/harmonic_coordinates.hpp"

namespace chladni::cases {

using Eigen::Vector3d;

namespace {

double angle_of(const Vector3d& x)
{
  constexpr double digits = 1e-9;
  const double angle = std::atan2(x.y(), x.x());
  return angle < -digits ? angle + 2.0 * std::numbers::pi : std::max(angle, 0.0);
}

/// Lumped masses and springs of the whole body, of which a sector has its share.
struct SectorPoints {
  std::vector<plate::PointMass> masses;
  std::vector<plate::Spring> springs;
};

/// Whether a name is a node on the axis; refused where nodes of the cut edges would count twice.
bool names_axis(const SectorModel& model, const std::string& what, const std::string& name)
{
  const std::vector<int> nodes = model.system.dofs.named_nodes(model.mesh, name);
  if (nodes.size() == 1 && is_on_axis(model, nodes[0])) return true;
  if (std::ranges::any_of(nodes, [&](int node) { return is_on_axis(model, node); })) {
    throw Error(fmt::format(
        "sectors: {} at \"{}\" stands at nodes on the axis and others, so that it would count in "
        "each sector; give the node on the axis a group of its own",
        what, name));
  }
  for (const auto& [low, high] : model.mesh.sectors.pairs) {
    if (std::ranges::find(nodes, high) == nodes.end()) continue;
    throw Error(fmt::format(
        "sectors: {} at \"{}\" stands on a cut edge of the sector, where it would count twice; "
        "cut the body elsewhere",
        what, name));
  }
  return false;
}

SectorPoints sector_points(const scene::Scene& scene, const SectorModel& model)
{
  SectorPoints points{.masses = scene.masses, .springs = scene.springs};
  const double share = 1.0 / model.mesh.sectors.count;
  for (plate::PointMass& mass : points.masses) {
    if (!names_axis(model, "the mass", mass.at)) continue;
    if (!turns_with_sectors(mass)) {
      throw Error(
          fmt::format("sectors: the mass at \"{}\" does not look the same from each "
                      "sector; give it inertia[0] = inertia[1], no products of inertia and "
                      "an offset along z alone",
                      mass.at));
    }
    mass.mass *= share;
    for (double& value : mass.inertia) value *= share;
  }
  for (plate::Spring& spring : points.springs) {
    bool on_axis = names_axis(model, "the spring", spring.at);
    if (spring.to) on_axis = names_axis(model, "the spring", *spring.to) && on_axis;
    if (!on_axis) continue;
    if (!turns_with_sectors(spring)) {
      throw Error(
          fmt::format("sectors: the spring at \"{}\" does not look the same from each "
                      "sector; give x the value of y, and rx that of ry",
                      spring.at));
    }
    for (double& value : spring.stiffness) value *= share;
    for (double& value : spring.damping) value *= share;
  }
  return points;
}

/// Nodes of the cut edges have the same motion, or follow the same.
std::vector<std::array<int, 2>> edge_blocks(const SectorModel& model)
{
  const plate::DofMap& dofs = model.system.dofs;
  std::vector<int> image(std::size_t(dofs.n_nodes()), -1);
  for (const auto& [low, high] : model.mesh.sectors.pairs) image[std::size_t(low)] = high;
  std::vector<std::array<int, 2>> blocks;
  for (const auto& [low, high] : model.mesh.sectors.pairs) {
    if (!dofs.is_dependent(low) && !dofs.is_dependent(high)) {
      blocks.push_back({dofs.number(low), dofs.number(high)});
      if (dofs.rotation_number(low) >= 0)
        blocks.push_back({dofs.rotation_number(low), dofs.rotation_number(high)});
      continue;
    }
    const int from = dofs.is_dependent(low) ? dofs.reference(low) : low;
    const int to = dofs.is_dependent(high) ? dofs.reference(high) : high;
    if ((from == to && is_on_axis(model, from)) || image[std::size_t(from)] == to) continue;
    throw Error(fmt::format(
        "sectors: nodes {} and {} of the cut edges are one of the body, but follow different "
        "nodes; cut the body where no coupling ends",
        model.mesh.node_numbers[std::size_t(low)], model.mesh.node_numbers[std::size_t(high)]));
  }
  return blocks;
}

/// Empty where no node has a second block.
std::vector<char> rotating_blocks(const plate::DofMap& dofs)
{
  std::vector<char> rotating(std::size_t(dofs.n_active()), 0);
  for (int node = 0; node < dofs.n_nodes(); ++node)
    if (const int block = dofs.rotation_number(node); block >= 0) rotating[std::size_t(block)] = 1;
  if (std::ranges::count(rotating, 1) == 0) rotating.clear();
  return rotating;
}

int highest_harmonic(const scene::Scene& scene, const std::string& ring, int n_nodes)
{
  const auto wanted = std::ranges::find(scene.ring_harmonics, ring, &plate::RingHarmonics::ring);
  return wanted == scene.ring_harmonics.end() ? n_nodes / 2 : wanted->up_to;
}

void add_ring(const scene::Scene& scene, SectorModel& model, const std::string& name,
              const std::vector<int>& nodes, const Eigen::MatrixX3d& axes)
{
  const auto& pairs = model.mesh.sectors.pairs;
  const plate::DofMap& dofs = model.system.dofs;
  cyclic::Ring ring{};
  std::vector<SectorNode> own;
  for (const int node : nodes) {
    if (dofs.rotation_number(node) >= 0) {
      throw Error(fmt::format(
          "sectors: \"{}\" is a ring of nodes with rotations in a model with solids, which is no "
          "interface of a sector; take a ring of the solid, or mesh the whole body",
          name));
    }
    const double angle = angle_of(dofs.position(node));
    ring.blocks.push_back(dofs.number(node));
    ring.angles.push_back(angle);
    const bool is_high = std::ranges::any_of(pairs, [&](const auto& p) { return p[1] == node; });
    if (is_high) continue;
    own.push_back({.node = node,
                   .block = dofs.number(node),
                   .ring = static_cast<int>(model.dofs.rings.size()),
                   .angle = angle,
                   .drilling_axis = axes.row(node)});
  }
  std::ranges::sort(own, {}, &SectorNode::angle);
  ring.n_nodes = static_cast<int>(own.size()) * model.mesh.sectors.count;
  ring.up_to = highest_harmonic(scene, name, ring.n_nodes);
  const double step = 2.0 * std::numbers::pi / ring.n_nodes;
  ring.first_angle = std::fmod(own.front().angle + 1e-9, step) - 1e-9;
  ring.first_angle = std::max(ring.first_angle, 0.0);
  check_ring(model, name, own, ring);
  if (ring.up_to > ring.n_nodes / 2 || ring.up_to < 1) {
    throw Error(
        fmt::format("ring \"{}\": harmonics = {}, but {} nodes show the harmonics 1 to {} "
                    "only; give fewer, or more nodes to the ring",
                    name, ring.up_to, ring.n_nodes, ring.n_nodes / 2));
  }
  model.dofs.rings.push_back(std::move(ring));
  model.interface.ring_names.push_back(name);
  model.interface.nodes.insert(model.interface.nodes.end(), own.begin(), own.end());
}

void add_interface(const scene::Scene& scene, SectorModel& model)
{
  const plate::DofMap& dofs = model.system.dofs;
  const Eigen::MatrixX3d axes = plate::drilling_axes(model.mesh, dofs);
  for (const std::string& name : scene.interface_nodes) {
    const std::vector<int> nodes = dofs.named_nodes(model.mesh, name);
    for (const int node : nodes) {
      if (!dofs.is_dependent(node)) continue;
      throw Error(
          fmt::format("interface node set \"{}\": node {} follows \"{}\"; put \"{}\" into "
                      "interface.nodes instead",
                      name, model.mesh.node_numbers[std::size_t(node)], dofs.followed(node),
                      dofs.followed(node)));
    }
    if (nodes.size() == 1 && is_on_axis(model, nodes[0])) {
      model.interface.nodes.push_back({.node = nodes[0],
                                       .block = dofs.number(nodes[0]),
                                       .rotations = dofs.rotation_number(nodes[0]),
                                       .ring = -1,
                                       .angle = 0.0,
                                       .drilling_axis = axes.row(nodes[0])});
      model.interface.axis_names.push_back(name);
    } else {
      add_ring(scene, model, name, nodes, axes);
    }
  }
}

/// Nodes on the axis are masters, or the harmonics would not know them.
void add_axis(SectorModel& model)
{
  for (const SectorNode& node : model.interface.nodes) {
    if (node.ring >= 0) continue;
    model.dofs.axis.push_back(node.block);
    if (!model.dofs.rotating.empty()) model.dofs.axis_rotations.push_back(node.rotations);
  }
  const plate::DofMap& dofs = model.system.dofs;
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    if (dofs.is_dependent(node) || !is_on_axis(model, node)) continue;
    const bool is_known =
        std::ranges::find(model.dofs.axis, dofs.number(node)) != model.dofs.axis.end();
    if (is_known) continue;
    throw Error(fmt::format("sectors: {} stands on the axis; put it into interface.nodes",
                            node < dofs.n_mesh_nodes()
                                ? fmt::format("node {}", model.mesh.node_numbers[std::size_t(node)])
                                : fmt::format("\"{}\"", dofs.reference_name(node))));
  }
}

}  // namespace

SectorModel sector_model(const scene::Scene& scene, mesh::Mesh mesh)
{
  expect_mass(scene);
  refuse_unsupported(scene);
  const std::vector<int> owners(std::size_t(mesh.n_nodes()), 0);
  plate::DofMap dofs = plate::make_dof_map(
      mesh, {.couplings = scene.couplings, .components = scene.components, .rings = {}}, owners, 1);
  SectorModel model{.mesh = std::move(mesh),
                    .masses = {},
                    .system = {.K = {}, .M = {}, .C = {}, .H = {}, .dofs = dofs},
                    .dofs = {},
                    .interface = {}};
  check_means(scene, model);
  const SectorPoints points = sector_points(scene, model);
  plate::Structure structure = structure_of(scene);
  structure.masses = points.masses;
  structure.springs = points.springs;
  model.masses = points.masses;
  model.system = plate::assemble(model.mesh, structure, std::move(dofs), PETSC_COMM_SELF);
  model.dofs = {.count = model.mesh.sectors.count,
                .n_blocks = model.system.dofs.n_active(),
                .components = model.system.dofs.components(),
                .edges = edge_blocks(model),
                .axis = {},
                .rings = {},
                .rotating = rotating_blocks(model.system.dofs)};
  add_interface(scene, model);
  add_axis(model);
  return model;
}

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

cyclic::SectorMatrices matrices_of(const SectorModel& model, MPI_Comm comm)
{
  const auto rows = [](Mat A) {
    return A != nullptr ? cyclic::sparse_rows(A) : cyclic::SparseRows();
  };
  return {.K = rows(model.system.K),
          .M = rows(model.system.M),
          .C = rows(model.system.C),
          .H = rows(model.system.H),
          .comm = comm};
}

std::optional<cyclic::Mirror> mirror_of(const SectorModel& model,
                                        const cyclic::SectorMatrices& matrices)
{
  const plate::DofMap& dofs = model.system.dofs;
  Eigen::MatrixX3d positions(model.dofs.n_blocks, 3);
  // A mean has no block of its own: its DOFs stand in those of its group.
  for (int node = 0; node < dofs.n_nodes(); ++node)
    for (const int block : {dofs.number(node), dofs.rotation_number(node)})
      if (!dofs.is_dependent(node) && block >= 0) positions.row(block) = dofs.position(node);
  return cyclic::find_mirror(model.dofs, positions,
                             {&matrices.K, &matrices.M, &matrices.C, &matrices.H});
}

}  // namespace chladni::cases
