#include "squeal/cycle/hopf_cycle.hpp"

#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/cycle/cycle_guess.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

/// Of the first cycle, relative to the compression of the pad: the speed departs from that of the
/// limit with its square.
constexpr double amplitude = 0.02;
/// Of the first Newton step, relative: the eigenvector misses the cycle by about the amplitude.
constexpr double largest_change = 0.5;

}  // namespace

std::optional<ArcPoint> cycle_at_hopf(const Brake& brake, const AutonomousMotionAt& motion,
                                      const StabilityPoint& limit)
{
  const double omega = 2.0 * pi * limit.frequency_Hz;
  if (!(omega > 0.0)) return std::nullopt;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(brake.state_matrix(limit.value));
  Eigen::Index i = 0;
  (solver.eigenvalues().array() - std::complex<double>(0.0, omega)).abs().minCoeff(&i);
  const std::unique_ptr<AutonomousMotion> at_limit = motion(limit.value);
  const Eigen::VectorXcd v =
      moving_the_pad(*at_limit, solver.eigenvectors().col(i), amplitude * brake.rest_compression());
  const Eigen::Index n = v.size();
  ArcPoint near{{v.real(), 2.0 * pi / omega}, limit.value, Eigen::VectorXd::Zero(n + 2)};
  near.tangent.head(n) = v.real().normalized();
  return corrected(motion, near, largest_change);
}

}  // namespace chladni::squeal
