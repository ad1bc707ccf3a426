#include <fmt/format.h>

#include <numbers>

#include "common/error.hpp"
#include "report/page/squeal_results.hpp"
#include "squeal/cycle/limit_cycle.hpp"

namespace chladni::report {
namespace {

using Eigen::Index;

constexpr double two_pi = 2.0 * std::numbers::pi;

/// Amplitudes of the modes used, among all modes of the body.
/// @throws chladni::Error when the body has no such modes: the results are of another one.
Eigen::VectorXcd spread(const Eigen::VectorXcd& amplitude, const std::vector<int>& mode_numbers,
                        Index n_modes)
{
  if (amplitude.size() != std::ssize(mode_numbers)) {
    throw Error(
        fmt::format("the results of squeal have {} modes, and the study {}: body or study have "
                    "changed since; make them again with `squeal run`",
                    amplitude.size(), mode_numbers.size()));
  }
  for (const int number : mode_numbers) {
    if (number >= 1 && number <= n_modes) continue;
    throw Error(
        fmt::format("the results of squeal name mode {}, and the body has {}: they are of another "
                    "body; make them again with `squeal run`",
                    number, n_modes));
  }
  Eigen::VectorXcd all = Eigen::VectorXcd::Zero(n_modes);
  for (std::size_t i = 0; i < mode_numbers.size(); ++i)
    all[mode_numbers[i] - 1] = amplitude[static_cast<Index>(i)];
  return all;
}

std::string name_of(const squeal::LimitCycle& cycle)
{
  if (!cycle.settled)
    return fmt::format("End of the transient at {:.5g} rad/s, not settled", cycle.speed);
  return fmt::format("Limit cycle at {:.5g} rad/s", cycle.speed);
}

std::string name_of(const squeal::DirectLimitCycle& cycle)
{
  return fmt::format("Limit cycle at {:.5g} rad/s{}", cycle.speed,
                     cycle.stable ? "" : ", not stable");
}

template <class Cycle>
void add_cycle(std::vector<Motion>& motions, const std::optional<Cycle>& cycle, Index n_modes)
{
  if (!cycle || cycle->amplitude.size() == 0) return;
  motions.push_back({.name = name_of(*cycle),
                     .frequency_Hz = cycle->frequency_Hz,
                     .amplitude = spread(cycle->amplitude, cycle->mode_numbers, n_modes)});
}

}  // namespace

std::vector<Motion> squeal_motions(const squeal::SquealResults& results,
                                   const std::vector<int>& mode_numbers, Index n_modes)
{
  std::vector<Motion> motions;
  // The first one is shown first.
  const bool unsettled = squeal::has_unsettled_end(results);
  if (!unsettled) add_cycle(motions, results.limit_cycle, n_modes);
  add_cycle(motions, results.limit_cycle_direct, n_modes);
  if (unsettled) add_cycle(motions, results.limit_cycle, n_modes);
  if (!results.eigenvalues || results.eigenvalues->shapes.empty()) return motions;
  const squeal::EigenvalueMap& map = *results.eigenvalues;
  Index i = 0, j = 0;
  const double growth = map.lambda.real().maxCoeff(&i, &j);
  const Eigen::VectorXcd shape = map.shapes[static_cast<std::size_t>(i)].col(j);
  const double f_Hz = map.lambda(i, j).imag() / two_pi;
  const std::vector<int>& numbers = map.mode_numbers.empty() ? mode_numbers : map.mode_numbers;
  // Behind the modes of the body are the displacements of pads with a mass.
  const Index n = map.mode_numbers.empty() ? shape.size() : std::ssize(map.mode_numbers);
  motions.push_back(
      {.name = fmt::format("Least stable at {:.5g} rad/s, {:+.3g} 1/s", map.speeds[i], growth),
       .frequency_Hz = f_Hz,
       .amplitude = spread(shape.head(n), numbers, n_modes)});
  return motions;
}

}  // namespace chladni::report
