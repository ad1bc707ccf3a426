#include "mbs_export/loaded_dofs.hpp"

#include <fmt/format.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/body_options.hpp"
#include "mbs_export/held_modes.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Receptances between all of them are compared at every frequency.
constexpr Index most_loads = 256;
/// Of loads that vary over the nodes of a set.
constexpr int highest_degree = 8;
/// Bolts and other points. Sets of more nodes are edges or surfaces, at whose single nodes forces
/// are a matter of the mesh; where all loads are too many, those of more than the second number.
constexpr std::size_t few_nodes = 24, fewer_nodes = 9;
/// On such sets, contact rings apart, where the scene names none.
constexpr Index most_on_edges = 96;

/// Components that change among themselves when a ring is turned about z.
constexpr std::array<std::array<int, 2>, 4> bundles{{{0, 1}, {2, 2}, {3, 4}, {5, 5}}};

/// Some components at nodes of a set.
struct SetLoad {
  std::string set;
  std::vector<int> nodes;
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

std::vector<SetLoad> loads_of(const ReducedSystem& reduced,
                              const std::vector<InterfaceModes>& wanted)
{
  std::vector<SetLoad> loads;
  for (const InterfaceModes& one : wanted) {
    loads.push_back({one.at, find_set(reduced, one.at).nodes, one.components,
                     one.kind == InterfaceModes::Kind::irm ? std::optional(0.0) : one.omega0});
  }
  return loads;
}

/// The nodes of a set whose component is not held; none where it is drilling or missing at any.
std::vector<int> free_nodes(const ReducedSystem& reduced, const HeldDofs& held,
                            const AttachmentSet& set, int component)
{
  const bool is_of_all = std::ranges::all_of(set.nodes, [&](int node) {
    return has_component(reduced, node, component) && !is_drilling(reduced, node, component);
  });
  std::vector<int> nodes = is_of_all ? set.nodes : std::vector<int>{};
  std::erase_if(nodes, [&](int node) {
    return std::ranges::find(held.dofs, 6 * node + component) != held.dofs.end();
  });
  return nodes;
}

/// Components with the same free nodes together.
std::vector<SetLoad> default_loads(const ReducedSystem& reduced, const HeldDofs& held,
                                   const std::vector<ContactRing>& rings)
{
  std::vector<SetLoad> loads;
  for (const AttachmentSet& set : reduced.sets) {
    // A ring that the support holds along z is a set as any other.
    const bool is_ring = std::ranges::find(rings, set.name, &ContactRing::name) != rings.end() &&
                         !free_nodes(reduced, held, set, 2).empty();
    const auto first = std::ssize(loads);
    for (int component = 0; component < 6; ++component) {
      std::vector<int> nodes = free_nodes(reduced, held, set, component);
      if (nodes.empty() || (is_ring && component != 2)) continue;
      const auto same = std::find_if(loads.begin() + first, loads.end(),
                                     [&](const SetLoad& load) { return load.nodes == nodes; });
      if (same != loads.end())
        same->components.push_back(component);
      else
        loads.push_back({set.name, std::move(nodes), {component}, {}});
    }
  }
  return loads;
}

/// Without loads a body is moved by its reactions alone, if the support holds all that a force
/// could move.
void refuse_no_loads(const ReducedSystem& reduced, const HeldDofs& held)
{
  for (const AttachmentSet& set : reduced.sets) {
    for (int component = 0; component < 6; ++component) {
      for (const int node : set.nodes) {
        if (!has_component(reduced, node, component) || is_drilling(reduced, node, component) ||
            std::ranges::find(held.dofs, 6 * node + component) != held.dofs.end())
          continue;
        throw BodyOptionError(
            "keep.tolerance",
            fmt::format(
                "{}.{} is free at node {}, but nothing would be loaded there: sets are loaded "
                "by what is drilling at none of their nodes; name the loads by "
                "interface_modes",
                set.name, component_name(component),
                reduced.attachment_nodes[std::size_t(node)].number));
      }
    }
  }
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

/// Positions about their mean along their principal axes, of which those are left out that are no
/// more than the digits of coordinates; the largest is 1.
/// @return [n_nodes x 0 to 3]
MatrixXd spread_out(const ReducedSystem& reduced, const std::vector<int>& nodes)
{
  constexpr double flat = 1e-4;
  MatrixXd X(std::ssize(nodes), 3);
  for (Index i = 0; i < X.rows(); ++i)
    X.row(i) = reduced.attachment_nodes[std::size_t(nodes[std::size_t(i)])].position.transpose();
  X.rowwise() -= X.colwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(MatrixXd(X.transpose() * X));
  X *= axes.eigenvectors().rowwise().reverse();
  const VectorXd extents = X.cwiseAbs().colwise().maxCoeff();
  if (!(extents[0] > 0.0)) return MatrixXd(X.rows(), 0);
  const Index n = (extents.array() > flat * extents[0]).count();
  return X.leftCols(n) / extents[0];
}

/// Orthonormal fields over nodes that span the polynomials of x, y and z up to a degree.
/// @return [n_nodes x k]
MatrixXd polynomials(const ReducedSystem& reduced, const std::vector<int>& nodes, int degree)
{
  // Coordinates of a file have six digits and more: a field of which less is left is made of
  // their round-off by more than its own share.
  constexpr double independent = 1e-3;
  const MatrixXd X = spread_out(reduced, nodes);
  MatrixXd fields = MatrixXd::Constant(X.rows(), 1, 1.0 / std::sqrt(double(X.rows())));
  Index first = 0;  // of those of the last degree
  for (int of = 1; of <= degree; ++of) {
    const Index end = fields.cols();
    for (Index j = first; j < end; ++j) {
      for (Index c = 0; c < X.cols(); ++c) {
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

LoadGroup group_of(const Pattern& pattern, Index n_loads)
{
  LoadGroup group{pattern.name, MatrixXd::Zero(n_loads, pattern.values.cols()), pattern.Omega_0};
  for (std::size_t i = 0; i < pattern.loads.size(); ++i)
    group.patterns.row(pattern.loads[i]) = pattern.values.row(Index(i));
  return group;
}

/// Which loads become polynomials of a degree: those of edges, or of contact rings too.
struct Spreading {
  int degree;
  bool of_rings;
  std::size_t few_nodes;
};

/// Collects the loads of sets.
class LoadList {
 public:
  LoadList(const ReducedSystem& reduced, const HeldDofs& held, std::optional<Spreading> spreading)
      : reduced_(reduced), held_(held), spreading_(spreading)
  {}

  void add(const SetLoad& load, const ContactRing* ring)
  {
    const std::vector<int>& nodes = load.nodes;
    const bool is_edge =
        ring == nullptr && nodes.size() > (spreading_ ? spreading_->few_nodes : few_nodes);
    const bool is_spread = spreading_ && (is_edge || (ring != nullptr && spreading_->of_rings));
    const Index n_before = n_loads();
    if (is_spread)
      add_polynomials(load, polynomials(reduced_, nodes, spreading_->degree));
    else if (ring != nullptr)
      add_ring(load, *ring);
    else
      add_nodes(load);
    const std::string degree =
        is_spread ? fmt::format(" of degree {}", spreading_->degree) : std::string();
    for (const int c : load.components)
      loads_.names.push_back(fmt::format("{}.{}{}", load.set, component_name(c), degree));
    if (is_edge) n_on_edges_ += n_loads() - n_before;
  }

  Index n_loads() const { return std::ssize(loads_.is_moment); }
  Index n_on_edges() const { return n_on_edges_; }

  LoadedDofs loads() const
  {
    LoadedDofs loads = loads_;
    if (spreading_) {
      loads.spread = MatrixXd::Zero(std::ssize(loads.dofs), n_loads());
      for (const Eigen::Triplet<double>& force : forces_)
        loads.spread(force.row(), force.col()) = force.value();
    }
    for (const Pattern& pattern : patterns_) loads.groups.push_back(group_of(pattern, n_loads()));
    return loads;
  }

 private:
  /// Places of these DOFs among the loaded ones; new ones are appended.
  std::vector<Index> enlisted(const std::vector<int>& nodes, int component)
  {
    std::vector<Index> places;
    for (const int dof : dofs_of(reduced_, held_, nodes, component)) {
      places.push_back(std::ranges::find(loads_.dofs, dof) - loads_.dofs.begin());
      if (places.back() == std::ssize(loads_.dofs)) loads_.dofs.push_back(dof);
    }
    return places;
  }

  /// Places of the loads of these nodes, each by itself; new ones are appended.
  std::vector<Index> single(const std::vector<int>& nodes, int component)
  {
    std::vector<Index> places;
    for (const Index dof : enlisted(nodes, component)) {
      const auto [known, is_new] = single_.try_emplace(dof, n_loads());
      places.push_back(known->second);
      if (!is_new) continue;
      forces_.emplace_back(int(dof), int(n_loads()), 1.0);
      loads_.is_moment.push_back(component >= 3);
    }
    return places;
  }

  /// The harmonics of a ring.
  void add_ring(const SetLoad& load, const ContactRing& ring)
  {
    for (const auto& bundle : bundles) {
      Pattern together{load.set + ".", {}, {}, load.Omega_0};
      for (const int component : load.components) {
        if (component < bundle[0] || component > bundle[1]) continue;
        together.name += component_name(component);
        for (const Index i : single(ring.nodes, component)) together.loads.push_back(i);
      }
      if (together.loads.empty()) continue;
      for (Pattern& pattern : ring_patterns(ring, together))
        patterns_.push_back(std::move(pattern));
    }
  }

  void add_nodes(const SetLoad& load)
  {
    for (const int component : load.components) {
      const std::vector<Index> places = single(load.nodes, component);
      for (std::size_t i = 0; i < places.size(); ++i) {
        std::string name = fmt::format("{}.{}", load.set, component_name(component));
        if (places.size() > 1) {
          const auto node = static_cast<std::size_t>(load.nodes[i]);
          name += fmt::format(" (node {})", reduced_.attachment_nodes[node].number);
        }
        patterns_.push_back({name, {places[i]}, MatrixXd::Ones(1, 1), load.Omega_0});
      }
    }
  }

  void add_polynomials(const SetLoad& load, const MatrixXd& fields)
  {
    for (const int component : load.components) {
      const std::vector<Index> places = enlisted(load.nodes, component);
      for (Index j = 0; j < fields.cols(); ++j) {
        for (Index i = 0; i < fields.rows(); ++i)
          forces_.emplace_back(int(places[std::size_t(i)]), int(n_loads()), fields(i, j));
        patterns_.push_back({fmt::format("{}.{}, field {}", load.set, component_name(component), j),
                             {n_loads()},
                             MatrixXd::Ones(1, 1),
                             load.Omega_0});
        loads_.is_moment.push_back(component >= 3);
      }
    }
  }

  const ReducedSystem& reduced_;
  const HeldDofs& held_;
  std::optional<Spreading> spreading_;
  LoadedDofs loads_;
  std::map<Index, Index> single_;  ///< the load of a DOF by itself
  std::vector<Eigen::Triplet<double>> forces_;
  std::vector<Pattern> patterns_;
  Index n_on_edges_ = 0;
};

/// Each DOF by itself, then edges by polynomials, the highest degree first, then smaller sets and
/// rings as well.
std::vector<std::optional<Spreading>> ways_to_load()
{
  std::vector<std::optional<Spreading>> ways{std::nullopt};
  for (const auto& [of_rings, few] :
       {std::pair{false, few_nodes}, {false, fewer_nodes}, {true, fewer_nodes}})
    for (int degree = highest_degree; degree >= 0; --degree)
      ways.emplace_back(Spreading{.degree = degree, .of_rings = of_rings, .few_nodes = few});
  return ways;
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
  const std::vector<SetLoad> sets =
      wanted.empty() ? default_loads(reduced, held, rings) : loads_of(reduced, wanted);
  if (sets.empty()) refuse_no_loads(reduced, held);
  for (const std::optional<Spreading>& way : ways_to_load()) {
    LoadList list(reduced, held, way);
    for (const SetLoad& load : sets) {
      const auto ring = std::ranges::find_if(rings, [&](const ContactRing& one) {
        return one.name == load.set && one.nodes.size() == load.nodes.size();
      });
      list.add(load, ring != rings.end() ? &*ring : nullptr);
    }
    const bool are_named = !wanted.empty();
    if (list.n_loads() <= most_loads && (are_named || list.n_on_edges() <= most_on_edges))
      return list.loads();
  }
  throw BodyOptionError(
      "keep.tolerance",
      fmt::format("{} sets are loaded, with more components than a tolerance can compare; name "
                  "those that matter by interface_modes",
                  sets.size()));
}

}  // namespace chladni::mbs_export
