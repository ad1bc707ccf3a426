#include "squeal/stability/unstable_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/stability/error_budget.hpp"
#include "squeal/stability/mode_limits.hpp"
#include "squeal/stability/mode_samples.hpp"
#include "squeal/stability/period_work.hpp"
#include "squeal/stability/stability_map.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Index;

constexpr double two_pi = 2.0 * std::numbers::pi;
/// Values that are looked at, at least.
constexpr int n_scanned = 128;

StateMatrixOf state_matrix_over(const Brake& brake, const StabilityCase& search)
{
  if (!search.over) return [&brake](double speed) { return brake.state_matrix(speed); };
  return [&brake, over = *search.over, speed = search.speed](double value) {
    return brake.with(over, value)->state_matrix(speed);
  };
}

/// So many times as fine as the values that were asked for.
int refinement(int count)
{
  return std::max(1, (n_scanned + count - 3) / (count - 1));
}

/// Motions that have a frequency of the band at one of the samples.
std::vector<Index> within_band(const std::vector<ModeSample>& samples,
                               const std::optional<FrequencyBand>& band)
{
  std::vector<Index> which;
  for (Index j = 0; j < samples.front().size(); ++j) {
    const bool within = !band || std::ranges::any_of(samples, [&](const ModeSample& sample) {
      const double f_Hz = sample.point(j).frequency_Hz;
      return f_Hz >= band->from_Hz && f_Hz <= band->to_Hz;
    });
    if (within) which.push_back(j);
  }
  return which;
}

/// Coordinates of the inertial disc that are one family of modes.
struct Coordinates {
  Index first, size;
};

std::vector<Coordinates> families_of(const InertialDisc& disc)
{
  std::vector<Coordinates> families;
  for (Index i = 0; i < disc.n_modes(); i += families.back().size)
    families.push_back({i, disc.nodal_diameters[static_cast<std::size_t>(i)] == 0 ? 1 : 2});
  return families;
}

/// Where the motion grows most, and what takes part in it: kinetic energy is |p|^2 / 2 of each
/// coordinate, the second half of an eigenvector (omega a, p).
const ModeSample& add_worst(StabilityBranch& branch, const std::vector<ModeSample>& samples,
                            Index j, const FlexibleDisc* body)
{
  const ModeSample& worst = *std::ranges::max_element(
      samples, {}, [j](const ModeSample& sample) { return sample.growth(j); });
  branch.worst = worst.point(j);
  if (!body) return worst;
  const Eigen::VectorXd p = worst.X.col(j).tail(worst.X.rows() / 2).cwiseAbs2();
  const auto families = families_of(body->inertial());
  branch.shares.resize(std::ssize(families));
  for (std::size_t i = 0; i < families.size(); ++i) {
    branch.shares[static_cast<Index>(i)] =
        p.segment(families[i].first, families[i].size).sum() / p.sum();
  }
  branch.pads = p.tail(p.size() - body->inertial().n_modes()).sum() / p.sum();
  return worst;
}

/// The works in a period of motion j, and the error of its growth; both absent without a body, and
/// where it does not oscillate.
void add_work_and_error(StabilityBranch& branch, const Brake& brake, const StabilityCase& search,
                        const ModeSample& sample, Index j)
{
  const std::complex<double> lambda = sample.lambda[j];
  if (!brake.body() || !(lambda.imag() > 0.0)) return;
  const auto there = search.over ? brake.with(*search.over, sample.value) : nullptr;
  const FlexibleDisc& body = there ? *there->body() : *brake.body();
  const double speed = there ? search.speed : sample.value;
  branch.work = period_work(body, speed, lambda, sample.X.col(j));
  branch.budget = growth_error_budget(body, speed, lambda);
}

/// Of the mode of the body that has the largest part in a coordinate of the inertial disc.
ModeFigure figure_of(const Disc& disc, const InertialDisc& inertial, Index coordinate)
{
  if (disc.figures.empty()) return {};
  Index mode = 0;
  inertial.R.col(coordinate).cwiseAbs().maxCoeff(&mode);
  return disc.figures[static_cast<std::size_t>(mode)];
}

/// Without its branches.
StabilityTable empty_table(const Brake& brake, const StabilityCase& search)
{
  StabilityTable table{.parameter = search.over ? key_of(*search.over) : "speed",
                       .speed = search.over ? std::optional(search.speed) : std::nullopt,
                       .band = search.band,
                       .values = Eigen::VectorXd::LinSpaced(search.count, search.from, search.to),
                       .families = {},
                       .branches = {},
                       .method = "eigenvalues"};
  if (const FlexibleDisc* body = brake.body()) {
    const InertialDisc& disc = body->inertial();
    for (const Coordinates& family : families_of(disc)) {
      const ModeFigure figure = figure_of(body->disc(), disc, family.first);
      table.families.push_back({disc.nodal_diameters[static_cast<std::size_t>(family.first)],
                                disc.omega[family.first] / two_pi, figure.circles,
                                figure.in_plane});
    }
  }
  return table;
}

}  // namespace

StabilityCase stability_case(const StudyOptions& options)
{
  const SpeedRange& speeds = options.speeds;
  return options.stability.value_or(StabilityCase{
      .over = {}, .from = speeds.from, .to = speeds.to, .count = speeds.count, .band = {}});
}

void require_band_of(const Disc& disc, const StabilityCase& search)
{
  if (!search.band) return;
  const double range = disc.compliance.empty()
                           ? disc.omega.maxCoeff()
                           : std::min(disc.omega.maxCoeff(), disc.compliance.lowest_omega);
  if (search.band->to_Hz * two_pi <= range) return;
  throw Error(fmt::format(
      "[squeal] stability.band_Hz = [{:.6g}, {:.6g}] goes beyond the modes of the body, "
      "{:.6g} to {:.6g} Hz; end it there, or take a body with more modes",
      search.band->from_Hz, search.band->to_Hz, disc.omega.minCoeff() / two_pi, range / two_pi));
}

StabilityTable unstable_modes(const Brake& brake, const StabilityCase& search,
                              const TurningTableOf& by_hill)
{
  if (const FlexibleDisc* body = brake.body()) {
    require_band_of(body->disc(), search);
    if (!brake.is_autonomous()) return by_hill(*body, search);
  }
  StabilityTable table = empty_table(brake, search);
  const StateMatrixOf A = state_matrix_over(brake, search);
  const int finer = refinement(search.count);
  std::vector<ModeSample> samples = followed_modes(
      A, {.from = search.from, .to = search.to, .count = finer * (search.count - 1) + 1});
  const std::vector<Index> which = within_band(samples, search.band);
  for (const Index j : which) {
    StabilityBranch branch{};
    branch.lambda.resize(search.count);
    for (Index i = 0; i < search.count; ++i)
      branch.lambda[i] = samples[static_cast<std::size_t>(finer * i)].lambda[j];
    table.branches.push_back(std::move(branch));
  }
  samples = with_hidden_changes(A, std::move(samples), which);
  for (std::size_t k = 0; k < which.size(); ++k) {
    table.branches[k].unstable = unstable_intervals(A, samples, which[k]);
    StabilityBranch& branch = table.branches[k];
    const ModeSample& worst = add_worst(branch, samples, which[k], brake.body());
    if (branch.is_unstable()) add_work_and_error(branch, brake, search, worst, which[k]);
  }
  std::ranges::stable_sort(table.branches, {},
                           [](const StabilityBranch& b) { return b.worst.frequency_Hz; });
  return table;
}

}  // namespace chladni::squeal
