#include "cases/mesh_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "cases/local_sizes.hpp"
#include "cases/mesh_frequencies.hpp"
#include "cases/mesh_scene.hpp"
#include "common/error.hpp"
#include "common/told_apart.hpp"

namespace chladni::cases {
namespace {

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

/// The search for a mesh.
class Search {
 public:
  Search(scene::Scene scene, const linear::SolverOptions& solver)
      : scene_(std::move(scene)), solver_(solver), target_(share_of_mesh * scene_.accuracy->error)
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
    constexpr int most_trials = 12;
    if (takes_places_ && !is_estimated(trial) && !keeps(trial))
      if (auto estimated = possible([&] { return tried(trial.size); }))
        trial = std::move(*estimated);
    const Trial even = trial;
    MeshSize next = next_size(trial, most_step);
    std::optional<Trial> much_larger;
    for (int i = 0; i < most_trials; ++i) {
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
      trial = next_trial(next, was_kept || !can_compare());
      if (keeps(trial)) continue;
      if (much_larger && is_stuck(*much_larger, trial)) break;
      if (!much_larger || trial.n_dofs > twice * much_larger->n_dofs) much_larger = trial;
    }
    if (keeps(trial)) return trial;
    const auto [reached, allowed] = told_apart(trial.error, target_);
    throw Error(fmt::format(
        "{}: accuracy.error = {:.6g} up to {:.6g} Hz: the mesh may have {} of it, and the best one "
        "that was tried, {}, has an error of {}; ask for {:.2g} or more, or choose the mesh "
        "yourself",
        scene_.path, scene_.accuracy->error, scene_.accuracy->up_to_Hz, allowed,
        described(trial.size), reached, possible_error(trial.error)));
  }

 private:
  bool keeps(const Trial& trial) const { return trial.error <= target_; }
  static bool is_estimated(const Trial& trial) { return trial.errors.omega.size() > 0; }
  /// As many elements as that should help.
  static constexpr double twice = 2.0;
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
    MeshErrors errors = frequencies.errors_up_to(two_pi * scene_.accuracy->up_to_Hz, solver_);
    const double largest = errors.largest();
    return kept({.size = size,
                 .n_dofs = frequencies.n_dofs(),
                 .error = largest,
                 .errors = std::move(errors)});
  }

  /// Its error against the known frequencies.
  Trial compared(MeshSize size)
  {
    MeshFrequencies frequencies = frequencies_on(size);
    if (const Trial* same = same_mesh(size, frequencies, false)) return *same;
    return kept({.size = size,
                 .n_dofs = frequencies.n_dofs(),
                 .error = error_against(known_, frequencies, solver_),
                 .errors = {}});
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

  /// The size at which a mesh like this one is expected to keep the target.
  double predicted_size(const Trial& trial) const
  {
    constexpr double smallest_step = 0.3;
    const double step = std::pow(0.7 * target_ / trial.error, 1.0 / rate_of(trial));
    return std::min(trial.size.size * std::clamp(step, smallest_step, most_step),
                    largest_size(scene_.mesh));
  }
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
  double target_;
  bool takes_places_ = takes_local_sizes(scene_.mesh);
  std::vector<Trial> trials_;
  Eigen::VectorXd known_;  ///< [k] rad/s, of the finer model of the first mesh
  double error_of_first_ = 0.0;
};

}  // namespace

double possible_error(double error_of_mesh)
{
  const double least = error_of_mesh / share_of_mesh;
  const double last_digit = std::pow(10.0, std::floor(std::log10(least)) - 1.0);
  return std::ceil(least / last_digit) * last_digit;
}

FoundMesh search_mesh(const scene::Scene& scene, const linear::SolverOptions& solver)
{
  Search search(scene, solver);
  Trial trial = search.refined(search.start());
  return {.size = trial.size, .errors = std::move(trial.errors)};
}

}  // namespace chladni::cases
