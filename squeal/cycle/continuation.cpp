#include "squeal/cycle/continuation.hpp"

#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/cycle/harmonic_balance.hpp"

namespace chladni::squeal {

using std::numbers::pi;

namespace {

constexpr int branch_newton_steps_max = 8;
/// Change, relative, at which Newton's method has converged.
constexpr double orbit_converged = 1e-7;
constexpr double flow_tolerance = 1e-9;
/// Step of the difference by the speed, relative: the integration leaves 1e-9, its second
/// derivative about as much.
constexpr double difference_by_speed = 1e-5;

/// The equations of a periodic motion at (x, T, speed) and their derivatives by
/// (x / |x|, ln T, ln speed); the last row is left to the caller.
struct ArcEquations {
  Eigen::MatrixXd J;         ///< [size + 2 x size + 2]
  Eigen::VectorXd residual;  ///< [size + 2], zero in the last two
};

ArcEquations equations_at(const AutonomousMotionAt& motion_at, const CycleStart& at, double speed)
{
  const std::unique_ptr<AutonomousMotion> motion = motion_at(speed);
  const std::unique_ptr<AutonomousMotion> faster = motion_at(speed * (1.0 + difference_by_speed));
  const Flow now = flow(*motion, at, flow_tolerance);
  const Eigen::Index n = at.x.size();
  const double scale = at.x.norm();
  ArcEquations equations{Eigen::MatrixXd::Zero(n + 2, n + 2), Eigen::VectorXd::Zero(n + 2)};
  Eigen::MatrixXd& J = equations.J;
  J.topLeftCorner(n, n) = scale * (now.derivative - Eigen::MatrixXd::Identity(n, n));
  J.col(n).head(n) = at.period * motion->rate_at(now.end);
  J.col(n + 1).head(n) = (end_of(*faster, at, flow_tolerance) - now.end) / difference_by_speed;
  J.row(n).head(n) = at.period * motion->rate_at(at.x).transpose();
  equations.residual.head(n) = at.x - now.end;
  return equations;
}

/// The direction of the branch, on the side of `along`.
std::optional<Eigen::VectorXd> tangent_of(ArcEquations equations, const Eigen::VectorXd& along)
{
  const Eigen::Index last = along.size() - 1;
  equations.J.row(last) = equations.J.row(last - 1).norm() * along.transpose();
  const Eigen::VectorXd tangent =
      equations.J.partialPivLu().solve(Eigen::VectorXd::Unit(along.size(), last));
  if (!tangent.allFinite() || !(tangent.norm() > 0.0)) return std::nullopt;
  return tangent.normalized();
}

void move(CycleStart& at, double& speed, const Eigen::VectorXd& change)
{
  const Eigen::Index n = at.x.size();
  at.x += at.x.norm() * change.head(n);
  at.period *= std::exp(change[n]);
  speed *= std::exp(change[n + 1]);
}

}  // namespace

std::optional<ArcPoint> arc_point(const AutonomousMotionAt& motion, const CycleStart& at,
                                  double speed, double direction)
{
  const Eigen::Index n = at.x.size() + 2;
  const auto tangent =
      tangent_of(equations_at(motion, at, speed), direction * Eigen::VectorXd::Unit(n, n - 1));
  if (!tangent) return std::nullopt;
  return ArcPoint{at, speed, *tangent};
}

std::optional<ArcPoint> next_on_arc(const AutonomousMotionAt& motion, const ArcPoint& point,
                                    double length)
{
  ArcPoint near = point;
  move(near.at, near.speed, length * point.tangent);
  return corrected(motion, near, 2.0 * std::abs(length));
}

std::optional<ArcPoint> corrected(const AutonomousMotionAt& motion, const ArcPoint& near,
                                  double largest_change)
{
  CycleStart at = near.at;
  double speed = near.speed;
  const Eigen::Index last = near.tangent.size() - 1;
  for (int i = 0; i < branch_newton_steps_max; ++i) {
    ArcEquations equations = equations_at(motion, at, speed);
    if (!equations.J.allFinite() || !equations.residual.allFinite()) return std::nullopt;
    const ArcEquations kept = equations;
    equations.J.row(last) = equations.J.row(last - 1).norm() * near.tangent.transpose();
    const Eigen::VectorXd change = equations.J.partialPivLu().solve(equations.residual);
    if (!change.allFinite() || change.norm() > largest_change) return std::nullopt;
    move(at, speed, change);
    if (change.norm() > orbit_converged) continue;
    const auto tangent = tangent_of(kept, near.tangent);
    if (!tangent) return std::nullopt;
    return ArcPoint{at, speed, *tangent};
  }
  return std::nullopt;
}

namespace {

/// Of the first cycle, relative to the compression of the pad: the speed departs from that of the
/// limit with its square.
constexpr double amplitude_at_limit = 0.02;
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
  const Eigen::VectorXcd v = moving_the_pad(*at_limit, solver.eigenvectors().col(i),
                                            amplitude_at_limit * brake.rest_compression());
  const Eigen::Index n = v.size();
  ArcPoint near{{v.real(), 2.0 * pi / omega}, limit.value, Eigen::VectorXd::Zero(n + 2)};
  near.tangent.head(n) = v.real().normalized();
  return corrected(motion, near, largest_change);
}

}  // namespace chladni::squeal
