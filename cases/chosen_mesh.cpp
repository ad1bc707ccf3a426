#include "cases/chosen_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "cases/mesh_errors.hpp"
#include "cases/ranks.hpp"
#include "cases/scene_mesh.hpp"
#include "common/error.hpp"
#include "common/told_apart.hpp"
#include "linear/solver_options.hpp"
#include "mesh/element_types.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/refinement/refined_mesh.hpp"
#include "report/progress.hpp"
#include "scene/keys.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

namespace {

/// The share of an accuracy that the mesh may use; the rest is for the reduction.
constexpr double share_of_mesh = 0.9;

/// " or ask for ..." with the least accuracy, of two digits, that a mesh with this error keeps;
/// nothing where no scene may ask for so little.
std::string or_ask_for_less(double error_of_mesh);

/// Larger models are not tried.
constexpr int most_dofs = 400'000;

/// A mesh that keeps the accuracy of a scene.
struct FoundMesh {
  MeshSize size;
  MeshErrors errors;
};

constexpr double two_pi = 2.0 * std::numbers::pi;

/// The largest error against known frequencies, by their order.
double error_against(const Eigen::VectorXd& known, MeshFrequencies& frequencies,
                     const linear::SolverOptions& solver)
{
  const Eigen::VectorXd omega = frequencies.like(known, solver);
  return (omega.cwiseQuotient(known).array() - 1.0).abs().maxCoeff();
}

/// A mesh that was tried.
struct Trial {
  MeshSize size;
  int n_dofs;
  double error;       ///< the largest
  MeshErrors errors;  ///< of each mode; empty where they were compared with known frequencies
};

/// By how much each halving of the elements lowers the largest error, of what acts at single nodes
/// of shells.
double per_halving(const MeshErrors& errors)
{
  if (errors.per_halving.size() == 0) return 0.0;
  Eigen::Index mode = 0;
  errors.errors.maxCoeff(&mode);
  return errors.per_halving[mode];
}

/// The part of the largest error that is theirs.
double of_points(const MeshErrors& errors)
{
  return errors.halvings * per_halving(errors);
}

/// No mesh keeps the accuracy.
class NoLimit : public Error {
 public:
  using Error::Error;
};

/// What acts at single nodes of shells lets no mesh of a possible size keep an accuracy.
void refuse_points(const scene::Scene& scene, const MeshErrors& errors)
{
  constexpr double possible_halvings = 2.0;
  const double target = share_of_mesh * scene.accuracy->error;
  if (of_points(errors) - possible_halvings * per_halving(errors) <= target) return;
  throw NoLimit(fmt::format(
      "{}: accuracy.error = {:.6g} up to {:.6g} Hz: what acts at single nodes of shells (support, "
      "spring, mass, coupling or beam) has no limit: each halving of the elements lowers a "
      "frequency by another {:.2g} of it, which is {:.2g} down to nodes a tenth of the thickness "
      "apart, and the mesh may have {:.2g}; spread it over an edge, or over the nodes around by a "
      "[[coupling]] whose group is an edge or a surface{}",
      scene.path, scene.accuracy->error, scene.accuracy->up_to_Hz, per_halving(errors),
      of_points(errors), target, or_ask_for_less(errors.largest())));
}

/// The search for a mesh.
class Search {
 public:
  Search(scene::Scene scene, const linear::SolverOptions& solver, Phases& phases)
      : scene_(std::move(scene)),
        solver_(solver),
        phases_(phases),
        target_(share_of_mesh * scene_.accuracy->error)
  {}

  /// Of the orders and edge rows that the scene leaves open, as meshes of about the first size tell
  /// them: the finer model of the first one is what the others are compared with.
  Trial start()
  {
    const double thickness = least_thickness(scene_);
    const MeshSize first{.size = first_size(scene_, two_pi * scene_.accuracy->up_to_Hz),
                         .order = order_of(scene_.mesh),
                         .edge_row = edge_row_of(scene_.mesh)};
    Trial best = first_trial(first);
    error_of_first_ = best.error;
    known_ = best.errors.finer;
    if (scene_.accuracy->chooses_edge_row && takes_edge_row(scene_.mesh, thickness) &&
        best.size.size > thickness) {
      MeshSize with_row = best.size;
      with_row.edge_row = thickness;
      best = cheaper(std::move(best), possible([&] { return compared(with_row); }));
    }
    if (!scene_.accuracy->chooses_order) return best;
    const MeshSize at = best.size;
    for (const int order : other_orders(scene_.mesh)) {
      MeshSize other = at;
      other.order = order;
      other.size = std::min(at.size * order / at.order, largest_size(scene_.mesh));
      best = cheaper(std::move(best), possible([&] { return compared(other); }));
    }
    return best;
  }

  /// From the size that the trial tells to smaller elements until the target is kept.
  Trial refined(Trial trial)
  {
    if (takes_places_ && !is_estimated(trial) && !keeps(trial))
      if (auto estimated = possible([&] { return tried(trial.size); }))
        trial = std::move(*estimated);
    const Trial even = trial;
    MeshSize next = next_size(trial, most_step);
    std::optional<Trial> much_larger;
    std::string untried = "smaller elements lower it no more";
    for (int i = 0;; ++i) {
      const bool was_kept = i > 0 && keeps(trial);
      if (was_kept && is_estimated(trial)) return trial;
      if (was_kept)
        next = trial.size;
      else if (i > 0)
        next = next_size(trial, 0.9);
      if (!next.places.empty()) {
        std::optional<Trial> local = possible([&] { return tried(next); });
        if (local && (keeps(*local) || local->error < 0.8 * trial.error)) {
          trial = std::move(*local);
        } else {  // the geometry says itself which elements it gets, or they cannot fill it
          takes_places_ = false;
          trial = even;
        }
        continue;
      }
      if (predicted_dofs(trial, next) > most_dofs) {
        untried = fmt::format("meshes of more than {} DOFs are not tried", most_dofs);
        break;
      }
      trial = next_trial(next, was_kept || !can_compare());
      if (keeps(trial)) continue;
      if (much_larger && is_stuck(*much_larger, trial)) break;
      if (!much_larger || trial.n_dofs > twice * much_larger->n_dofs) much_larger = trial;
    }
    const auto [reached, allowed] = told_apart(trial.error, target_);
    throw Error(fmt::format(
        "{}: accuracy.error = {:.6g} up to {:.6g} Hz: the mesh may have {} of it, and the best one "
        "that was tried, {}, has an error of {}; {}: choose the mesh yourself{}",
        scene_.path, scene_.accuracy->error, scene_.accuracy->up_to_Hz, allowed,
        described(trial.size), reached, untried, or_ask_for_less(trial.error)));
  }

 private:
  bool keeps(const Trial& trial) const { return trial.error <= target_; }
  static bool is_estimated(const Trial& trial) { return trial.errors.omega.size() > 0; }
  /// As many elements as that should help.
  static constexpr double twice = 2.0;
  static double predicted_dofs(const Trial& trial, const MeshSize& next)
  {
    const double finer = trial.size.size / next.size;
    return trial.n_dofs * finer * finer;
  }
  bool is_stuck(const Trial& larger, const Trial& smaller) const
  {
    return is_estimated(larger) && is_estimated(smaller) && !keeps(smaller) &&
           smaller.n_dofs > twice * larger.n_dofs && smaller.error > 0.9 * larger.error;
  }
  /// Whether the known frequencies are much better than what is wanted.
  bool can_compare() const
  {
    constexpr double share_of_finer = 0.1;  // of the error, with elements of half the size
    return share_of_finer * error_of_first_ < 0.3 * target_;
  }

  /// On a mesh of this size, which is rounded.
  MeshFrequencies frequencies_on(MeshSize& size) const
  {
    size.size = rounded(size.size);
    scene::Scene scene = scene_;
    set_size(scene.mesh, size);
    return {scene, mesh_on_all_ranks(scene)};
  }

  /// With an estimate of its error.
  Trial tried(MeshSize size)
  {
    MeshFrequencies frequencies = frequencies_on(size);
    if (const Trial* same = same_mesh(size, frequencies, true)) return *same;
    show("errors of mesh", size);
    MeshErrors errors = frequencies.errors_up_to(two_pi * scene_.accuracy->up_to_Hz, solver_);
    const double largest = errors.largest();
    const Trial& trial = kept({.size = size,
                               .n_dofs = frequencies.n_dofs(),
                               .error = largest,
                               .errors = std::move(errors)});
    refuse_points(scene_, trial.errors);
    return trial;
  }

  /// Its error against the known frequencies.
  Trial compared(MeshSize size)
  {
    MeshFrequencies frequencies = frequencies_on(size);
    if (const Trial* same = same_mesh(size, frequencies, false)) return *same;
    show("frequencies of mesh", size);
    return kept({.size = size,
                 .n_dofs = frequencies.n_dofs(),
                 .error = error_against(known_, frequencies, solver_),
                 .errors = {}});
  }

  void show(const char* step, const MeshSize& size)
  {
    phases_.show_step(fmt::format("{} {}: {}", step, trials_.size() + 1, described(size)));
  }

  /// A trial of a mesh with as many elements, which takes the size for its own: generators round
  /// their numbers.
  const Trial* same_mesh(const MeshSize& size, const MeshFrequencies& frequencies, bool estimated)
  {
    const auto found = std::ranges::find_if(trials_, [&](const Trial& trial) {
      return trial.size.places.empty() && size.places.empty() && trial.size.order == size.order &&
             trial.size.edge_row == size.edge_row && trial.n_dofs == frequencies.n_dofs() &&
             is_estimated(trial) == estimated;
    });
    if (found == trials_.end()) return nullptr;
    found->size = size;
    return &*found;
  }

  const Trial& kept(Trial trial) { return trials_.emplace_back(std::move(trial)); }

  /// Of that size, or a little smaller where its elements cannot fill the body.
  Trial next_trial(MeshSize size, bool estimates)
  {
    constexpr double smaller = 0.85;
    const auto attempt = [&] { return estimates ? tried(size) : compared(size); };
    if (std::optional<Trial> trial = possible(attempt)) return std::move(*trial);
    size.size *= smaller;
    return attempt();
  }

  /// The size at which a mesh like this one is expected to keep the target. What acts at points
  /// leaves less of it to the rest.
  double predicted_size(const Trial& trial) const
  {
    const double points = of_points(trial.errors), lost = per_halving(trial.errors);
    const double rest = trial.error - points;
    double step = std::pow(0.7 * target_ / std::max(rest, 1e-3 * target_), 1.0 / rate_of(trial));
    constexpr double smaller = 0.95;
    while (lost > 0.0 && step > smallest_step &&
           rest * std::pow(step, rate_of(trial)) / 0.7 + points + lost * std::log2(step) > target_)
      step *= smaller;
    return std::min(trial.size.size * std::clamp(step, smallest_step, most_step),
                    largest_size(scene_.mesh));
  }
  static constexpr double smallest_step = 0.3;
  static constexpr double most_step = 1.4;  ///< from a mesh to one of larger elements
  /// With the size of the elements the error falls by this power or faster: by 2 order for a smooth
  /// mode on small elements.
  static double rate_of(const Trial& trial) { return trial.size.order + 1.0; }

  /// The mesh that is expected to keep the target: elements are smaller everywhere, or, where that
  /// takes clearly fewer of them, at places.
  /// @param largest  of its sizes, as a part of those of the trial
  MeshSize next_size(const Trial& trial, double largest) const
  {
    constexpr double clearly = 0.7;
    MeshSize next = trial.size;
    next.size = std::min(predicted_size(trial), largest * trial.size.size);
    next.places.clear();
    const std::vector<ErrorShare>& shares = trial.errors.shares;
    if (!takes_places_ || shares.empty()) return next;
    LocalSizes local = local_sizes(shares, 0.7 * target_ / trial.error, rate_of(trial));
    const double finer = trial.size.size / next.size;
    const bool is_local = !trial.size.places.empty();
    if (!is_local && local.n_elements > clearly * finer * finer * n_elements(shares)) return next;
    next.size = is_local ? trial.size.size
                         : std::min(most_step * trial.size.size, largest_size(scene_.mesh));
    next.places = std::move(local.sizes);
    return next;
  }

  /// The work on a mesh of that size, and with the finer one that tells its error: by its DOFs, and
  /// the entries of a row of the matrices.
  double predicted_work(const Trial& trial) const
  {
    const double finer = trial.size.size / predicted_size(trial);
    return trial.n_dofs * finer * finer * (0.6 + 0.2 * trial.size.order);
  }

  Trial cheaper(Trial one, std::optional<Trial> other) const
  {
    if (!other || predicted_work(*other) >= predicted_work(one)) return one;
    return std::move(*other);
  }

  /// Nothing where elements of that size and order cannot fill the body.
  template <class Try>
  static std::optional<Trial> possible(const Try& attempt)
  {
    try {
      return attempt();
    } catch (const NoLimit&) {
      throw;
    } catch (const Error&) {
      return std::nullopt;
    }
  }

  /// Of that size or, where large elements would fold over, of smaller ones.
  Trial first_trial(MeshSize size)
  {
    constexpr int most_attempts = 4;
    constexpr double smaller = 0.6;
    for (int i = 1; i < most_attempts; ++i, size.size *= smaller)
      if (std::optional<Trial> trial = possible([&] { return tried(size); }))
        return std::move(*trial);
    return tried(size);
  }

  scene::Scene scene_;
  linear::SolverOptions solver_;
  Phases& phases_;
  double target_;
  bool takes_places_ = takes_local_sizes(scene_.mesh);
  std::vector<Trial> trials_;
  Eigen::VectorXd known_;  ///< [k] rad/s, of the finer model of the first mesh
  double error_of_first_ = 0.0;
};

std::string or_ask_for_less(double error_of_mesh)
{
  const double least = error_of_mesh / share_of_mesh;
  const double last_digit = std::pow(10.0, std::floor(std::log10(least)) - 1.0);
  const double possible = std::ceil(least / last_digit) * last_digit;
  return possible <= scene::accuracy_error_max ? fmt::format(", or ask for {:.2g}", possible) : "";
}

/// Searches the cheapest mesh that keeps the accuracy.
/// @param scene  with the supports under which its frequencies are meant
/// @note   Collective.
/// @throws chladni::Error when no mesh keeps the accuracy, with the error of the best one.
FoundMesh search_mesh(const scene::Scene& scene, const linear::SolverOptions& solver,
                      Phases& phases)
{
  Search search(scene, solver, phases);
  Trial trial = search.refined(search.start());
  return {.size = trial.size, .errors = std::move(trial.errors)};
}

/// Of what the scene's body wants to be right.
double range_of(const scene::Scene& scene)
{
  if (scene.accuracy) return scene.accuracy->up_to_Hz;
  if (scene.reduce.tolerance) return scene.reduce.tolerance->up_to_Hz;
  if (scene.body.keep.tolerance) return scene.body.keep.tolerance->up_to_Hz;
  if (scene.body.keep.up_to_Hz) return *scene.body.keep.up_to_Hz;
  if (scene.reduce.cutoff_Hz) return *scene.reduce.cutoff_Hz;
  scene::refuse_key(
      scene, "reduce.mesh_errors",
      "up to which frequency? give reduce.tolerance or body.keep with up_to_Hz, or cutoff_Hz");
}

/// @param mesh  the mesh, in words
void tell_choice(const MeshChoice& choice, const std::string& mesh)
{
  const scene::Accuracy& accuracy = *choice.scene.accuracy;
  on_first_rank([&] {
    report::tell_note(
        fmt::format("accuracy {:.1e} up to {:.6g} Hz: {}; estimated error of the mesh {:.1e}",
                    accuracy.error, accuracy.up_to_Hz, mesh, choice.errors->largest()));
  });
}

/// The nodes at the ends of an edge, the lower first.
using Ends = std::array<int, 2>;

/// The largest angle, rad, at which straight elements or their free edges go on where the body is
/// smooth; 0 where it is flat there.
double largest_bend(const mesh::Mesh& mesh)
{
  constexpr double degree = std::numbers::pi / 180.0, least = 0.2 * degree, kink = 30.0 * degree;
  const auto at = [&](int node) { return mesh.positions[std::size_t(node)]; };
  std::map<Ends, std::vector<mesh::Vector>> normals;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (block.order > 1 || !mesh::is_surface(block.shape)) continue;
    for (int e = 0; e < block.n_elements(); ++e) {
      const auto edges = mesh::edges_of(block, e);
      const mesh::Vector normal =
          mesh::unit(mesh::cross(mesh::minus(at(edges[0][1]), at(edges[0][0])),
                                 mesh::minus(at(edges[1][1]), at(edges[1][0]))));
      for (const auto& edge : edges)
        normals[Ends{std::min(edge[0], edge[1]), std::max(edge[0], edge[1])}].push_back(normal);
    }
  }
  double bend = 0.0;
  const auto add = [&](const mesh::Vector& a, const mesh::Vector& b) {
    const double angle = std::acos(std::min(1.0, std::abs(mesh::dot(a, b))));
    if (angle > least && angle < kink) bend = std::max(bend, angle);
  };
  std::map<int, std::vector<mesh::Vector>> free;
  for (const auto& [ends, of_elements] : normals) {
    if (of_elements.size() == 2) add(of_elements[0], of_elements[1]);
    if (of_elements.size() > 1) continue;
    for (const int node : ends)
      free[node].push_back(mesh::unit(mesh::minus(at(ends[1]), at(ends[0]))));
  }
  for (const auto& [node, edges] : free)
    if (edges.size() == 2) add(edges[0], edges[1]);
  return bend;
}

/// What straight elements lose of a curved body, which smaller ones do not give back.
std::string told_shape(const mesh::Mesh& mesh)
{
  const double bend = largest_bend(mesh);
  if (bend == 0.0) return "";
  return fmt::format(
      ", whose shape stays as it is: straight elements that go on at {:.2g} degrees leave a curve "
      "by "
      "{:.1e} of its radius, which no estimate includes",
      bend * 180.0 / std::numbers::pi, bend * bend / 8.0);
}

/// Named points keep their nodes, and no element folds over.
bool is_possible(const mesh::Mesh& own, int order)
{
  try {
    return plate::keeps_points(own, split(own, {.order = order}));
  } catch (const Error&) {
    return false;
  }
}

/// Ways to split the elements of a file, the cheapest first: orders up to 3 that are possible,
/// then halves.
std::vector<Split> ways_to_split(const mesh::Mesh& own)
{
  constexpr int highest = 3, most_halvings = 4;
  std::vector<Split> ways;
  Split last;
  for (int order = own.blocks.front().order + 1; order <= highest; ++order) {
    if (!is_possible(own, order)) continue;
    last.order = order;
    ways.push_back(last);
  }
  for (last.halvings = 1; last.halvings <= most_halvings; ++last.halvings) ways.push_back(last);
  return ways;
}

std::string described(const Split& into, const std::string& file)
{
  std::string text = fmt::format("the elements of {}", file);
  if (into.order) text += fmt::format(" raised to order {}", *into.order);
  if (into.halvings > 0)
    text += fmt::format("{} halved {} times", into.order ? " and" : "", into.halvings);
  return text;
}

/// The best of the meshes that were tried.
struct BestSplit {
  double error;
  std::string mesh;          ///< in words
  std::string untried = {};  ///< why others were not
};

[[noreturn]] void refuse_splits(const scene::Scene& scene, const BestSplit& best)
{
  const auto [reached, most] = told_apart(best.error, share_of_mesh * scene.accuracy->error);
  throw Error(fmt::format(
      "{}: accuracy.error = {:.6g}: the mesh may have {} of it, and that of {} has an error of "
      "{} up to {:.6g} Hz{}: give a finer one{}",
      scene.path, scene.accuracy->error, most, best.mesh, reached, scene.accuracy->up_to_Hz,
      best.untried, or_ask_for_less(best.error)));
}

/// The mesh of a file that has its own, with its elements split until they keep the accuracy.
/// @param own  the choice of `mesh`, whose errors are too large
MeshChoice split_mesh(const scene::Scene& supported, const MeshChoice& own, const mesh::Mesh& mesh,
                      const linear::SolverOptions& solver, Phases& phases)
{
  const scene::Scene& scene = own.scene;
  const std::string& file = *scene.mesh.file;
  BestSplit best{.error = own.errors->largest(), .mesh = file};
  if (!scene.resultants.elements.empty()) {
    best.untried = "; reduce.resultant_elements needs its elements as they are";
    refuse_splits(scene, best);
  }
  for (const Split& into : ways_to_split(mesh)) {
    const std::string name = described(into, file);
    try {
      MeshFrequencies frequencies(supported, split(mesh, into));
      if (const int n = frequencies.n_dofs(); n > most_dofs) {
        best.untried +=
            fmt::format("; {} would have {} DOFs, and meshes of more than {} are not tried", name,
                        n, most_dofs);
        break;
      }
      phases.show_step("errors of " + name);
      MeshErrors errors = frequencies.errors_up_to(two_pi * scene.accuracy->up_to_Hz, solver);
      refuse_points(scene, errors);
      if (errors.largest() < best.error) best = {errors.largest(), name, best.untried};
      if (errors.largest() > share_of_mesh * scene.accuracy->error) continue;
      MeshChoice choice{.scene = scene, .errors = std::move(errors)};
      set_split(choice.scene.mesh, into);
      tell_choice(choice, name + told_shape(mesh));
      return choice;
    } catch (const NoLimit&) {
      throw;
    } catch (const Error& error) {  // of a refined mesh, on all ranks alike
      best.untried += fmt::format("; {}: {}", name, error.what());
    }
  }
  refuse_splits(scene, best);
}

/// A mesh of solids is not split: halves are eight times as many. At edges and bores errors fall
/// with the square of the size at most.
[[noreturn]] void refuse_solids(const scene::Scene& scene, double error)
{
  const double most = share_of_mesh * scene.accuracy->error;
  const auto [reached, may] = told_apart(error, most);
  throw Error(fmt::format(
      "{}: accuracy.error = {:.6g}: the mesh may have {} of it, and this one of solids has an "
      "error of {} up to {:.6g} Hz: take elements of {:.2g} times this size, or a row of small "
      "ones along the edges{}",
      scene.path, scene.accuracy->error, may, reached, scene.accuracy->up_to_Hz,
      0.95 * std::sqrt(most / error), or_ask_for_less(error)));
}

MeshChoice own_mesh(const scene::Scene& supported, const scene::Scene& scene,
                    const linear::SolverOptions& solver, Phases& phases)
{
  const mesh::Mesh mesh = mesh_on_all_ranks(scene);
  MeshChoice choice{
      .scene = scene,
      .errors = MeshFrequencies(supported, mesh).errors_up_to(two_pi * range_of(scene), solver)};
  if (!scene.accuracy) return choice;
  if (choice.errors->largest() <= share_of_mesh * scene.accuracy->error) {
    tell_choice(choice, described({}, scene.mesh.file.value_or("the mesh")) + told_shape(mesh));
    return choice;
  }
  refuse_points(scene, *choice.errors);
  if (!scene.solids.empty()) refuse_solids(scene, choice.errors->largest());
  return split_mesh(supported, choice, mesh, solver, phases);
}

}  // namespace

std::vector<plate::Support> supports_of(const scene::Scene& scene)
{
  std::vector<plate::Support> supports;
  const std::vector<std::string>& sets = scene.interface_nodes;
  for (const std::string& name : scene.body.fixed) {
    const bool is_set = std::ranges::find(sets, name) != sets.end();  // it may have a dot
    const std::size_t dot = is_set ? std::string::npos : name.rfind('.');
    const std::string component = dot == std::string::npos ? "" : name.substr(dot + 1);
    const auto known = std::ranges::find(plate::component_names, component);
    if (known == plate::component_names.end()) {
      supports.push_back({.group = name, .components = {0, 1, 2, 3, 4, 5}});
    } else {
      const auto c = static_cast<int>(known - plate::component_names.begin());
      supports.push_back({.group = name.substr(0, dot), .components = {c}});
    }
  }
  return supports;
}

MeshChoice chosen_mesh(const scene::Scene& scene, const std::vector<plate::Support>& supports,
                       const linear::SolverOptions& solver, Phases& phases)
{
  if (!scene.accuracy && !scene.mesh_errors) return {.scene = scene, .errors = {}};
  phases.begin("errors of the mesh");
  scene::Scene supported = scene;
  supported.supports = supports;
  if (!scene.accuracy || !has_size(scene.mesh) || !scene.solids.empty())
    return own_mesh(supported, scene, solver, phases);
  FoundMesh found = search_mesh(supported, solver, phases);
  MeshChoice choice{.scene = scene, .errors = std::move(found.errors)};
  set_size(choice.scene.mesh, found.size);
  tell_choice(choice, described(found.size));
  return choice;
}

namespace {

/// The elastic modes up to a frequency (rad/s), and the next one where there is one.
reduce::NaturalModes modes_up_to(const SupportedModel& model, double omega,
                                 const linear::SolverOptions& solver)
{
  const int n_rigid = plate::n_free_motions(model.free);
  const reduce::FreeDofs free = reduce::free_dofs(model.system.K, model.held);
  const int most =
      std::max(1, (model.system.dofs.n_dofs() - static_cast<int>(model.held.size())) / 3);
  for (int n = std::min(n_rigid + 24, most);; n = std::min(2 * n, most)) {
    reduce::NaturalModes modes = reduce::natural_modes(
        model.system.K, model.system.M, free, {.n_modes = n, .n_rigid = n_rigid, .solver = solver});
    if (n == most || modes.lambda.back() > omega * omega) return modes;
  }
}

/// The modes up to a frequency; the first elastic one in any case.
reduce::NaturalModes modes_in_range(const SupportedModel& model, double omega,
                                    const linear::SolverOptions& solver)
{
  reduce::NaturalModes modes = modes_up_to(model, omega, solver);
  const int n_rigid = plate::n_free_motions(model.free);
  const auto in_range = static_cast<int>(
      std::ranges::count_if(modes.lambda, [&](double lambda) { return lambda <= omega * omega; }));
  modes.lambda.resize(static_cast<std::size_t>(
      std::min(std::max(in_range, n_rigid + 1), static_cast<int>(modes.lambda.size()))));
  return modes;
}

/// The lowest elastic modes.
Eigen::VectorXd lowest_of(const SupportedModel& model, Eigen::Index n,
                          const linear::SolverOptions& solver)
{
  const int n_rigid = plate::n_free_motions(model.free);
  const reduce::NaturalModes modes = reduce::natural_modes(
      model.system.K, model.system.M, reduce::free_dofs(model.system.K, model.held),
      {.n_modes = n_rigid + static_cast<int>(n), .n_rigid = n_rigid, .solver = solver});
  Eigen::VectorXd omega(n);
  for (Eigen::Index i = 0; i < n; ++i)
    omega[i] = std::sqrt(std::max(modes.lambda[static_cast<std::size_t>(n_rigid + i)], 0.0));
  return omega;
}

}  // namespace

MeshFrequencies::MeshFrequencies(const scene::Scene& scene, mesh::Mesh mesh)
    : scene_(scene),
      mesh_(std::make_unique<const mesh::Mesh>(std::move(mesh))),
      sector_(SectorFrequencies::find(scene, *mesh_))
{
  if (!sector_) whole();
}

const SupportedModel& MeshFrequencies::whole()
{
  if (!whole_) whole_ = assemble_supported(scene_, *mesh_);
  return *whole_;
}

int MeshFrequencies::n_dofs() const
{
  return sector_ ? sector_->n_dofs() : whole_->system.dofs.n_dofs();
}

Eigen::VectorXd MeshFrequencies::like(const Eigen::VectorXd& known,
                                      const linear::SolverOptions& solver)
{
  const Eigen::Index n = known.size();
  if (!sector_) return lowest_of(whole(), n, solver);
  constexpr double step = 1.1, most = 10.0;
  for (double share = 1.02; share < most; share *= step) {
    const Eigen::VectorXd found = sector_->up_to(share * known[n - 1], solver);
    if (found.size() >= n) return found.head(n);
  }
  throw Error("a coarse mesh has too few modes");
}

MeshErrors MeshFrequencies::errors_up_to(double omega, const linear::SolverOptions& solver)
{
  if (sector_) {
    if (std::optional<MeshErrors> found = sector_->errors_up_to(omega, solver)) return *found;
  }
  return mesh_errors(scene_, whole(), modes_in_range(whole(), omega, solver), solver);
}

// An element of size h at a place has the error c h^r for each area, and 1 / h^2 elements fill it.
// Of all sizes with the same error the fewest elements have h = kappa c^(-1 / (r + 2)); with I the
// integral of c^(2 / (r + 2)) their error is kappa^r I.
LocalSizes local_sizes(const std::vector<ErrorShare>& shares, double reduction, double rate)
{
  constexpr double smallest_step = 0.1, largest_step = 1.4;
  const auto density = [&](const ErrorShare& at) {
    return at.share / at.area / std::pow(at.size, rate);
  };
  double error = 0.0, integral = 0.0;
  for (const ErrorShare& at : shares) {
    error += at.share;
    integral += at.area * std::pow(density(at), 2.0 / (rate + 2.0));
  }
  const double kappa = std::pow(reduction * error / integral, 1.0 / rate);
  LocalSizes found{.sizes = {}, .n_elements = 0.0};
  for (const ErrorShare& at : shares) {
    const double wanted =
        kappa * std::pow(density(at), -1.0 / (rate + 2.0));  // infinite without error
    const double size =
        rounded(std::clamp(wanted, smallest_step * at.size, largest_step * at.size));
    found.sizes.push_back({.x = at.x, .size = size});
    found.n_elements += at.area / (size * size);
  }
  return found;
}

double n_elements(const std::vector<ErrorShare>& shares)
{
  double n = 0.0;
  for (const ErrorShare& at : shares) n += at.area / (at.size * at.size);
  return n;
}

}  // namespace chladni::cases
