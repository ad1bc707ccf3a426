#include <algorithm>
#include <cmath>
#include <numbers>

#include "cases/attachments.hpp"
#include "cases/sector_model.hpp"
#include "cyclic/turn.hpp"

namespace chladni::cases {

namespace {

/// The nodes of a ring all around, by angle; the first one is the first of the sector.
struct WholeRing {
  std::vector<int> nodes;  ///< indices in attachment_nodes
  std::vector<double> angles;
};

/// F of the masters of a ring.
void add_shapes(Eigen::MatrixXd& F, const WholeRing& whole, const cyclic::Ring& ring,
                const std::vector<mbs_export::MasterDof>& masters, int set)
{
  for (Eigen::Index column = 0; column < std::ssize(masters); ++column) {
    const auto& master = masters[static_cast<std::size_t>(column)];
    if (!master.harmonic || master.harmonic->set != set) continue;
    const int d = master.harmonic->order;
    const bool is_highest = 2 * d == ring.n_nodes;
    const double length = std::sqrt((d == 0 || is_highest ? 1.0 : 2.0) / ring.n_nodes);
    for (std::size_t i = 0; i < whole.nodes.size(); ++i) {
      const double phase = d * (whole.angles[i] - (is_highest ? ring.first_angle : 0.0));
      const double value = length * (master.harmonic->is_sine ? std::sin(phase) : std::cos(phase));
      F.block<3, 1>(6 * whole.nodes[i] + 3 * (master.component / 3), column) =
          value * cyclic::turn(whole.angles[i]).col(master.component % 3);
    }
  }
}

int add_attachment(mbs_export::ReducedSystem& whole, const SectorModel& model,
                   const SectorNode& node, int sector)
{
  const std::int64_t n_numbers = model.mesh.node_numbers.back() + model.system.dofs.n_nodes();
  const Eigen::Matrix3d R = cyclic::turn_of_sector(sector, model.mesh.sectors.count);
  whole.attachment_nodes.push_back(
      {.number = node_number(model.mesh, model.system.dofs, node.node) + sector * n_numbers,
       .position = R * model.system.dofs.position(node.node),
       .drilling_axis = R * node.drilling_axis});
  return static_cast<int>(whole.attachment_nodes.size()) - 1;
}

/// Adds the nodes of all sectors, sector by sector, and their set, by angle.
WholeRing add_whole_ring(mbs_export::ReducedSystem& whole, const SectorModel& model, int index)
{
  constexpr double digits = 1e-9;
  std::vector<std::pair<double, int>> by_angle;
  for (int sector = 0; sector < model.mesh.sectors.count; ++sector) {
    const double start = 2.0 * std::numbers::pi * sector / model.mesh.sectors.count;
    for (const SectorNode& node : model.interface.nodes) {
      if (node.ring != index) continue;
      by_angle.emplace_back(std::fmod(node.angle + start + digits, 2.0 * std::numbers::pi) - digits,
                            add_attachment(whole, model, node, sector));
    }
  }
  std::ranges::sort(by_angle);
  WholeRing ring;
  for (const auto& [angle, node] : by_angle) {
    ring.angles.push_back(angle);
    ring.nodes.push_back(node);
  }
  whole.sets.push_back(
      {.name = model.interface.ring_names[std::size_t(index)], .nodes = ring.nodes});
  return ring;
}

/// The wanted harmonics of the last set.
void add_ring_masters(mbs_export::ReducedSystem& whole, const SectorModel& model, int index)
{
  const cyclic::Ring& ring = model.dofs.rings[std::size_t(index)];
  const int set = static_cast<int>(whole.sets.size()) - 1;
  for (int k = 0; k < std::min(2 * ring.up_to + 1, ring.n_nodes); ++k) {
    for (const int c : model.dofs.components) {
      whole.masters.push_back(
          {.node = -1,
           .component = c,
           .harmonic = mbs_export::RingHarmonic{
               .set = set, .order = (k + 1) / 2, .is_sine = k > 0 && k % 2 == 0}});
    }
  }
}

/// F of all masters: the sets of nodes on the axis stand before those of rings.
Eigen::MatrixXd shapes_of(const mbs_export::ReducedSystem& whole, const SectorModel& model,
                          const std::vector<WholeRing>& rings, int n_axis)
{
  Eigen::MatrixXd F =
      Eigen::MatrixXd::Zero(6 * std::ssize(whole.attachment_nodes), std::ssize(whole.masters));
  for (Eigen::Index i = 0; i < std::ssize(whole.masters); ++i) {
    const auto& master = whole.masters[static_cast<std::size_t>(i)];
    if (master.node >= 0) F(6 * master.node + master.component, i) = 1.0;
  }
  for (std::size_t r = 0; r < rings.size(); ++r)
    add_shapes(F, rings[r], model.dofs.rings[r], whole.masters, n_axis + static_cast<int>(r));
  return F;
}

}  // namespace

mbs_export::ReducedSystem described_whole(const scene::Scene& scene, const SectorModel& model)
{
  mbs_export::ReducedSystem whole;
  whole.title = scene.title;
  int n_axis = 0;
  for (const SectorNode& node : model.interface.nodes) {
    if (node.ring >= 0) continue;
    const int place = add_attachment(whole, model, node, 0);
    whole.sets.push_back(
        {.name = model.interface.axis_names[std::size_t(n_axis++)], .nodes = {place}});
    for (const int c : scene.components) whole.masters.push_back({.node = place, .component = c});
  }
  std::vector<WholeRing> rings;
  for (int r = 0; r < std::ssize(model.dofs.rings); ++r) {
    rings.push_back(add_whole_ring(whole, model, r));
    add_ring_masters(whole, model, r);
  }
  const Eigen::MatrixXd F = shapes_of(whole, model, rings, n_axis);
  whole.ring_motion = {.shapes = F, .displacements = F};  // of the masters alone
  return whole;
}

int master_index(const mbs_export::ReducedSystem& whole, const SectorModel& model,
                 const cyclic::Master& master)
{
  const auto n_axis = static_cast<int>(model.dofs.axis.size());
  const auto found = std::ranges::find_if(whole.masters, [&](const mbs_export::MasterDof& dof) {
    if (dof.component != master.component) return false;
    if (master.ring < 0) return dof.node == master.place;
    return dof.harmonic && dof.harmonic->set == n_axis + master.ring &&
           dof.harmonic->order == (master.place + 1) / 2 &&
           dof.harmonic->is_sine == (master.place > 0 && master.place % 2 == 0);
  });
  return static_cast<int>(found - whole.masters.begin());
}

SectorSupport sector_support(const scene::Scene& scene, const SectorModel& model)
{
  struct Held {
    int ring, place;
    std::vector<int> components;
  };
  std::vector<Held> held;
  SectorSupport support;
  for (const std::string& fixed : scene.body.fixed) {
    const std::string::size_type dot = fixed.rfind('.');
    const auto place_in = [](const std::vector<std::string>& names, const std::string& name) {
      const auto it = std::ranges::find(names, name);
      return it == names.end() ? -1 : static_cast<int>(it - names.begin());
    };
    int component = -1;
    std::string name = fixed;
    const auto& [nodes, axis, rings] = model.interface;
    if (place_in(axis, name) < 0 && place_in(rings, name) < 0 && dot != std::string::npos) {
      name = fixed.substr(0, dot);
      component = place_in({"x", "y", "z", "rx", "ry", "rz"}, fixed.substr(dot + 1));
    }
    // A component across the axis is no component of a harmonic.
    if (component >= 0 && component % 3 != 2) continue;
    const std::vector<int> components =
        component >= 0 ? std::vector{component} : std::vector{0, 1, 2, 3, 4, 5};
    if (const int place = place_in(axis, name); place >= 0) {
      held.push_back({.ring = -1, .place = place, .components = components});
      support.names.push_back(fixed);
    }
    const int ring = place_in(rings, name);
    if (ring < 0) continue;
    const cyclic::Ring& wanted = model.dofs.rings[std::size_t(ring)];
    if (wanted.up_to < wanted.n_nodes / 2) continue;
    held.push_back({.ring = ring, .place = -1, .components = components});
    support.names.push_back(fixed);
  }
  support.is_held = [held](const cyclic::Master& master) {
    return std::ranges::any_of(held, [&](const Held& one) {
      return one.ring == master.ring && (one.place < 0 || one.place == master.place) &&
             std::ranges::find(one.components, master.component) != one.components.end();
    });
  };
  return support;
}

}  // namespace chladni::cases
