#include "mbs_export/loaded_dofs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/body_options.hpp"
#include "mbs_export/held_modes.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Receptances between all of them are compared at every frequency.
constexpr std::size_t most_loads = 256;
/// Of loads that vary over the nodes of a set.
constexpr int highest_degree = 8;

/// Components that change among themselves when a ring is turned about z.
constexpr std::array<std::array<int, 2>, 4> bundles{{{0, 1}, {2, 2}, {3, 4}, {5, 5}}};

/// Some components at all nodes of a set.
struct SetLoad {
  std::string set;
  std::vector<int> components;
  std::optional<double> Omega_0;
};

/// Loads with an index for each pattern row, while the number of loads is still open.
struct Pattern {
  std::string name;
  std::vector<Index> loads;
  MatrixXd values;  ///< [loads x k]
  std::optional<double> Omega_0;
};

std::vector<SetLoad> loads_of(const std::vector<InterfaceModes>& wanted)
{
  std::vector<SetLoad> loads;
  for (const InterfaceModes& one : wanted) {
    loads.push_back({one.at, one.components,
                     one.kind == InterfaceModes::Kind::irm ? std::optional(0.0) : one.omega0});
  }
  return loads;
}

/// Components that all nodes of a set have, and that are neither held nor drilling at any.
std::vector<int> free_components(const ReducedSystem& reduced, const HeldDofs& held,
                                 const AttachmentSet& set)
{
  const auto is_free = [&](int node, int component) {
    return has_component(reduced, node, component) && !is_drilling(reduced, node, component) &&
           std::ranges::find(held.dofs, 6 * node + component) == held.dofs.end();
  };
  std::vector<int> components;
  for (int component = 0; component < 6; ++component) {
    if (!set.nodes.empty() &&
        std::ranges::all_of(set.nodes, [&](int node) { return is_free(node, component); }))
      components.push_back(component);
  }
  return components;
}

std::vector<SetLoad> default_loads(const ReducedSystem& reduced, const HeldDofs& held,
                                   const std::vector<ContactRing>& rings)
{
  std::vector<SetLoad> loads;
  for (const AttachmentSet& set : reduced.sets) {
    std::vector<int> components = free_components(reduced, held, set);
    if (std::ranges::find(rings, set.name, &ContactRing::name) != rings.end())
      std::erase_if(components, [](int component) { return component != 2; });
    if (!components.empty()) loads.push_back({set.name, components, {}});
  }
  return loads;
}

/// cos(n phi), sin(n phi) at the nodes, orthonormal, [N x 2]; [N x 1] where the sine vanishes.
MatrixXd harmonic(const VectorXd& angles, Index n)
{
  const Index N = angles.size();
  // Counted from the first node, so that the highest harmonic of an even ring has its cosine.
  const Eigen::ArrayXd phase = static_cast<double>(n) * (angles.array() - angles[0]);
  MatrixXd F(N, n == 0 || 2 * n == N ? 1 : 2);
  F.col(0) = phase.cos();
  if (F.cols() == 2) F.col(1) = phase.sin();
  return F.colwise().normalized();
}

/// Places of these DOFs among the loads; new ones are appended.
std::vector<Index> enlist(LoadedDofs& loads, const std::vector<int>& dofs, int component)
{
  std::vector<Index> places;
  for (const int dof : dofs) {
    places.push_back(std::ranges::find(loads.dofs, dof) - loads.dofs.begin());
    if (places.back() < Index(loads.dofs.size())) continue;
    loads.dofs.push_back(dof);
    loads.is_moment.push_back(component >= 3);
  }
  return places;
}

std::vector<int> dofs_of(const ReducedSystem& reduced, const HeldDofs& held,
                         const std::vector<int>& nodes, int component)
{
  std::vector<int> dofs;
  for (const int node : nodes) dofs.push_back(loaded_dof(reduced, held, {node, component}));
  return dofs;
}

/// The harmonics of those components of a load that turn together.
std::vector<Pattern> ring_patterns(const ContactRing& ring, const Pattern& loads)
{
  const Index N = ring.angles.size(), n_components = Index(loads.loads.size()) / N;
  std::vector<Pattern> patterns;
  for (Index n = 0; n <= N / 2; ++n) {
    const MatrixXd F = harmonic(ring.angles, n);
    MatrixXd values = MatrixXd::Zero(n_components * N, n_components * F.cols());
    for (Index i = 0; i < n_components; ++i) values.block(i * N, i * F.cols(), N, F.cols()) = F;
    patterns.push_back(
        {fmt::format("{}, {} diameters", loads.name, n), loads.loads, values, loads.Omega_0});
  }
  return patterns;
}

/// Enlists the loads of a ring and returns their harmonics.
std::vector<Pattern> add_ring(LoadedDofs& loads, const ReducedSystem& reduced, const HeldDofs& held,
                              const SetLoad& load, const ContactRing& ring)
{
  std::vector<Pattern> patterns;
  for (const auto& bundle : bundles) {
    Pattern together{load.set + ".", {}, {}, load.Omega_0};
    for (const int component : load.components) {
      if (component < bundle[0] || component > bundle[1]) continue;
      together.name += component_name(component);
      for (const Index i : enlist(loads, dofs_of(reduced, held, ring.nodes, component), component))
        together.loads.push_back(i);
    }
    if (together.loads.empty()) continue;
    for (Pattern& pattern : ring_patterns(ring, together)) patterns.push_back(std::move(pattern));
  }
  return patterns;
}
/// Enlists the loads of a set and returns each as a pattern of its own.
std::vector<Pattern> add_set(LoadedDofs& loads, const ReducedSystem& reduced, const HeldDofs& held,
                             const SetLoad& load)
{
  std::vector<Pattern> patterns;
  const std::vector<int>& nodes = find_set(reduced, load.set).nodes;
  for (const int component : load.components) {
    const std::vector<Index> places =
        enlist(loads, dofs_of(reduced, held, nodes, component), component);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      std::string name = fmt::format("{}.{}", load.set, component_name(component));
      if (nodes.size() > 1)
        name += fmt::format(" (node {})", reduced.attachment_nodes[std::size_t(nodes[i])].number);
      patterns.push_back({name, {places[i]}, MatrixXd::Ones(1, 1), load.Omega_0});
    }
  }
  return patterns;
}

LoadGroup group_of(const Pattern& pattern, Index n_loads)
{
  LoadGroup group{pattern.name, MatrixXd::Zero(n_loads, pattern.values.cols()), pattern.Omega_0};
  for (std::size_t i = 0; i < pattern.loads.size(); ++i)
    group.patterns.row(pattern.loads[i]) = pattern.values.row(Index(i));
  return group;
}

/// Orthonormal fields over nodes that span the polynomials of x, y and z up to a degree.
/// @return [n_nodes x k]
MatrixXd polynomials(const ReducedSystem& reduced, const std::vector<int>& nodes, int degree)
{
  constexpr double independent = 1e-8;
  MatrixXd X(std::ssize(nodes), 3);
  for (Index i = 0; i < X.rows(); ++i)
    X.row(i) = reduced.attachment_nodes[std::size_t(nodes[std::size_t(i)])].position.transpose();
  X.rowwise() -= X.colwise().mean().eval();
  if (const double extent = X.cwiseAbs().maxCoeff(); extent > 0.0) X /= extent;
  MatrixXd fields = MatrixXd::Constant(X.rows(), 1, 1.0 / std::sqrt(double(X.rows())));
  Index first = 0;  // of those of the last degree
  for (int of = 1; of <= degree; ++of) {
    const Index end = fields.cols();
    for (Index j = first; j < end; ++j) {
      for (Index c = 0; c < 3; ++c) {
        VectorXd next = X.col(c).cwiseProduct(fields.col(j));
        for (int twice = 0; twice < 2; ++twice) next -= fields * (fields.transpose() * next).eval();
        if (next.norm() < independent) continue;
        fields.conservativeResize(Eigen::NoChange, fields.cols() + 1);
        fields.rightCols(1) = next.normalized();
      }
    }
    first = end;
  }
  return fields;
}

/// The nodes of each set loaded together, by polynomials up to a degree.
LoadedDofs spread_loads(const ReducedSystem& reduced, LoadedDofs loads,
                        const std::vector<SetLoad>& sets, const HeldDofs& held, int degree)
{
  loads.is_moment.clear();
  loads.names.clear();
  loads.spread.resize(std::ssize(loads.dofs), 0);
  std::vector<Pattern> patterns;
  for (const SetLoad& load : sets) {
    const std::vector<int>& nodes = find_set(reduced, load.set).nodes;
    const MatrixXd fields = polynomials(reduced, nodes, degree);
    for (const int component : load.components) {
      loads.names.push_back(
          fmt::format("{}.{} of degree {}", load.set, component_name(component), degree));
      const Index first = loads.spread.cols();
      loads.spread.conservativeResize(Eigen::NoChange, first + fields.cols());
      loads.spread.rightCols(fields.cols()).setZero();
      const std::vector<int> dofs = dofs_of(reduced, held, nodes, component);
      for (std::size_t i = 0; i < dofs.size(); ++i) {
        const Index row = std::ranges::find(loads.dofs, dofs[i]) - loads.dofs.begin();
        loads.spread.row(row).tail(fields.cols()) = fields.row(Index(i));
      }
      for (Index j = 0; j < fields.cols(); ++j) {
        loads.is_moment.push_back(component >= 3);
        patterns.push_back({fmt::format("{}.{}, field {}", load.set, component_name(component), j),
                            {first + j},
                            MatrixXd::Ones(1, 1),
                            load.Omega_0});
      }
    }
  }
  loads.groups.clear();
  for (const Pattern& pattern : patterns)
    loads.groups.push_back(group_of(pattern, loads.spread.cols()));
  return loads;
}

/// By polynomials of the highest degree that a selection can compare.
LoadedDofs spread_over_sets(const ReducedSystem& reduced, const LoadedDofs& loads,
                            const std::vector<SetLoad>& sets, const HeldDofs& held)
{
  for (int degree = highest_degree; degree >= 0; --degree) {
    LoadedDofs spread = spread_loads(reduced, loads, sets, held, degree);
    if (spread.is_moment.size() <= most_loads) return spread;
  }
  throw BodyOptionError(
      "keep.tolerance",
      fmt::format("{} sets are loaded, with more components than the {} loads that a tolerance can "
                  "compare; name those that matter by interface_modes",
                  sets.size(), most_loads));
}

}  // namespace

MatrixXd LoadedDofs::worked_on(const MatrixXd& motions) const
{
  return spread.size() > 0 ? spread.transpose() * motions : motions;
}

int loaded_dof(const ReducedSystem& reduced, const HeldDofs& held, MasterDof loaded)
{
  const int dof = attachment_dof(reduced, loaded.node, loaded.component);
  const auto found = std::ranges::find(held.dofs, dof);
  if (found != held.dofs.end()) {
    throw BodyOptionError("interface_modes",
                          fmt::format("{} is held; a load there moves nothing",
                                      held.names[std::size_t(found - held.dofs.begin())]));
  }
  refuse_drilling_load(reduced, loaded.node, loaded.component);
  return dof;
}

LoadedDofs loaded_dofs(const ReducedSystem& reduced, const HeldDofs& held,
                       const std::vector<InterfaceModes>& wanted)
{
  const std::vector<ContactRing> rings =
      contact_rings(reduced, MatrixXd(6 * Index(reduced.attachment_nodes.size()), 0));
  LoadedDofs loads;
  std::vector<Pattern> patterns;
  const std::vector<SetLoad> sets =
      wanted.empty() ? default_loads(reduced, held, rings) : loads_of(wanted);
  for (const SetLoad& load : sets) {
    const auto ring = std::ranges::find(rings, load.set, &ContactRing::name);
    for (Pattern& pattern : ring != rings.end() ? add_ring(loads, reduced, held, load, *ring)
                                                : add_set(loads, reduced, held, load))
      patterns.push_back(std::move(pattern));
    for (const int component : load.components)
      loads.names.push_back(fmt::format("{}.{}", load.set, component_name(component)));
  }
  if (loads.dofs.size() > most_loads) return spread_over_sets(reduced, loads, sets, held);
  for (const Pattern& pattern : patterns)
    loads.groups.push_back(group_of(pattern, Index(loads.dofs.size())));
  return loads;
}

}  // namespace chladni::mbs_export
