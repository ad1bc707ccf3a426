#include "squeal/cycle/cycle_harmonics.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/cycle/periodic_orbit.hpp"
#include "squeal/motion/disc_motion.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

/// The first multiple of the frequency that is taken for a lower one is 120, which is rounding.
constexpr int samples_of_harmonics = 128;
/// Of the integration over the period.
constexpr double harmonics_tolerance = 1e-10;

}  // namespace

Eigen::MatrixXcd cycle_harmonics(const Disc& disc, const SquealOptions& options,
                                 const DirectLimitCycle& cycle)
{
  const InertialDisc inertial = inertial_disc(disc);
  SlidingDisc motion(inertial, options, cycle.speed);
  const Eigen::MatrixXd x = states_over_period(motion, {cycle.x, 1.0 / cycle.frequency_Hz},
                                               samples_of_harmonics, harmonics_tolerance);
  Eigen::MatrixXcd harmonics = Eigen::MatrixXcd::Zero(inertial.n_modes(), n_cycle_harmonics);
  for (int i = 0; i < samples_of_harmonics; ++i) {
    const Eigen::VectorXd a = x.col(i).head(inertial.n_modes()).cwiseQuotient(inertial.omega);
    for (int h = 1; h <= n_cycle_harmonics; ++h) {
      harmonics.col(h - 1) +=
          std::polar(2.0 / samples_of_harmonics, -2.0 * pi * h * i / samples_of_harmonics) * a;
    }
  }
  harmonics = inertial.R * harmonics;
  Eigen::Index largest = 0;
  harmonics.col(0).cwiseAbs().maxCoeff(&largest);
  const double phase = std::arg(harmonics(largest, 0));
  for (int h = 1; h <= n_cycle_harmonics; ++h) harmonics.col(h - 1) *= std::polar(1.0, -h * phase);
  return harmonics;
}

}  // namespace chladni::squeal
