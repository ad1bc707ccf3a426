#include "squeal/stability/hill.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "common/error.hpp"
#include "linear/dense/real_eigenvalues.hpp"
#include "squeal/stability/group_exponents.hpp"
#include "squeal/stability/near_groups.hpp"
#include "squeal/stability/turning_modes.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

constexpr Eigen::Index n_samples_max = 1024;
/// Part of the tolerance that harmonics left out of the equations may take.
constexpr double left_out = 0.1;
/// Of a period, for the disc that stands; no harmonic below it repeats at these angles.
constexpr int n_frozen_angles = 24;

/// Of all groups, and what the sum of their growth rates is off the trace.
HillExponents exponents_of(const std::vector<NearGroup>& groups, const TurningModes& modes)
{
  std::vector<std::complex<double>> all;
  HillExponents result{{}, 0, 0.0, 0, 0};
  double trace = modes.lambda.sum().real();
  for (const NearGroup& group : groups) {
    const GroupExponents found = group_exponents(group, modes.step);
    trace -= (group.has_mirror ? 2.0 : 1.0) * found.lambda.sum().real();
    for (const std::complex<double>& lambda : found.lambda)
      if (group.has_mirror || lambda.imag() >= 0.0) all.push_back(lambda);
    result.error = std::max({result.error, group.error, found.error});
    result.coupled = std::max(result.coupled, found.lambda.size());
  }
  std::ranges::sort(all, [](const auto& a, const auto& b) { return a.real() > b.real(); });
  result.lambda = Eigen::Map<Eigen::VectorXcd>(all.data(), static_cast<Eigen::Index>(all.size()));
  result.error = std::max(result.error, std::abs(trace));
  return result;
}

}  // namespace

Hill::Hill(const Disc& disc, const SquealOptions& options, double tolerance)
    : disc_(disc),
      options_(options),
      tolerance_(tolerance),
      coordinates_(nearest_pairs(disc)),
      bound_(2 * highest_harmonic(disc, coordinates_))
{}

TurningHarmonics Hill::harmonics(double speed) const
{
  return turning_harmonics(brake(speed), speed, bound_, left_out * tolerance_);
}

int Hill::nu(double speed) const
{
  return harmonics(speed).nu;
}

HillExponents Hill::exponents(double speed) const
{
  const TurningHarmonics harmonics = this->harmonics(speed);
  const int nu = std::max(1, harmonics.nu);
  const Eigen::Index highest = harmonics.highest / nu;
  for (Eigen::Index N = power_of_two(2 * highest + 1); N <= n_samples_max; N *= 2) {
    const TurningModes modes = turning_modes(harmonics, N);
    const std::vector<NearGroup> groups = near_groups(modes, tolerance_);
    double error = 0.0;
    for (const NearGroup& group : groups) error = std::max(error, group.error);
    if (error > tolerance_) continue;
    HillExponents result = exponents_of(groups, modes);
    result.error += harmonics.left;
    result.nu = harmonics.nu;
    result.harmonics = nu * static_cast<int>(highest == 0 ? 0 : groups.front().highest);
    return result;
  }
  throw Error(
      fmt::format("rotation-stability at {:.6g} rad/s: {} harmonics of the rotation are not enough "
                  "for a growth "
                  "rate to {:.1e} 1/s; use rotation_stability = {{ method = \"floquet\" }}",
                  speed, n_samples_max / 2 * nu, tolerance_));
}

double Hill::frozen_growth(double speed, int nu) const
{
  TurningBrake frozen = brake(speed);
  nu = std::max(1, nu);
  double growth = -std::numeric_limits<double>::infinity();
  for (int s = 0; s < n_frozen_angles; ++s) {
    // Each in another period: those harmonics that were left out of the motion count here.
    const double angle = 2.0 * pi * (double(s) / n_frozen_angles + s % nu) / nu;
    growth = std::max(growth, linear::real_eigenvalues(frozen.at(angle)).real().maxCoeff());
  }
  return growth;
}

}  // namespace chladni::squeal
