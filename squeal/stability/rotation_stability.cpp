#include "squeal/stability/rotation_stability.hpp"

#include <cmath>
#include <numbers>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake/ring_shapes.hpp"
#include "squeal/motion/oscillator_flow.hpp"
#include "squeal/parallel.hpp"
#include "squeal/root.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

/// For a period of the highest mode, at first; twice as many follow, and from both the limit of the
/// growth with the square of the step.
constexpr int steps_per_period = 14;
/// Of the critical speed, relative; the steps leave more.
constexpr double speed_error = 1e-7;

/// Small motions of disc and pads in the frame of the disc, many at a time, each a column.
class LinearSteps {
 public:
  LinearSteps(const Disc& disc, const SquealOptions& options, double speed, double step)
      : speed_(speed),
        step_(step),
        pads_(pad_system(options, ring_places(disc))),
        rings_(disc.rings.begin(), disc.rings.end()),
        brake_(free_brake(disc, pads_, 0.0)),
        G_(Eigen::MatrixXd::Zero(brake_.omega.size(), brake_.omega.size())),
        flow_(brake_.omega, brake_.C, 0.5 * step)
  {
    G_.topLeftCorner(disc.n_modes(), disc.n_modes()) = disc.G;
    for (const PointPair& point : pads_.points) {
      shapes_.push_back(pair_shapes(rings_[point.ring].at(point.angle), pads_, point));
      derivatives_.push_back(
          pair_derivatives(point.contact, speed, static_cast<int>(shapes_.back().cols())));
    }
  }

  const Eigen::VectorXd& omega() const { return brake_.omega; }

  /// Half a flow, the kick of the pads in the middle by the explicit midpoint rule, half a flow.
  void advance(ModalColumns& x, double t_middle)
  {
    flow_.advance(x);
    const double angle = speed_ * t_middle;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      const PointPair& point = pads_.points[i];
      const Eigen::MatrixX3d& S = rings_[point.ring].at(point.angle - angle);
      shapes_[i].topLeftCorner(S.rows(), 3) = S;
    }
    x.v += step_ * force(x.q, x.v + 0.5 * step_ * force(x.q, x.v));
    flow_.advance(x);
  }

 private:
  Eigen::MatrixXd force(const Eigen::MatrixXd& q, const Eigen::MatrixXd& v) const
  {
    Eigen::MatrixXd F = -2.0 * speed_ * (G_ * v);
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      const PairShapes& S = shapes_[i];
      const Eigen::MatrixXd at_point =
          derivatives_[i].D_a * (S.transpose() * q) + derivatives_[i].D_p * (S.transpose() * v);
      F.noalias() += S * at_point;
    }
    return F;
  }

  double speed_, step_;
  PadSystem pads_;
  std::vector<RingShapes> rings_;
  FreeBrake brake_;
  Eigen::MatrixXd G_;
  OscillatorFlow flow_;
  std::vector<PairShapes> shapes_;
  std::vector<PairDerivatives> derivatives_;
};

/// By so many steps for a period of the highest mode.
RotationGrowth growth_by(int n, const Disc& disc, const SquealOptions& options, double speed)
{
  const double rotation = 2.0 * pi / speed;
  const Eigen::VectorXd plates = pad_system(options, ring_places(disc)).omega;
  const double highest =
      std::max(disc.omega.maxCoeff(), plates.size() > 0 ? plates.maxCoeff() : 0.0);
  const auto n_steps = static_cast<std::int64_t>(std::ceil(rotation * highest * n / (2.0 * pi)));
  const double step = rotation / double(n_steps);
  LinearSteps steps(disc, options, speed, step);
  const Eigen::Index m = steps.omega().size();
  ModalColumns x{Eigen::MatrixXd::Zero(m, 2 * m), Eigen::MatrixXd::Zero(m, 2 * m)};
  x.q.leftCols(m) = steps.omega().cwiseInverse().asDiagonal();
  x.v.rightCols(m).setIdentity();
  for (std::int64_t i = 0; i < n_steps; ++i) steps.advance(x, (double(i) + 0.5) * step);

  Eigen::MatrixXd monodromy(2 * m, 2 * m);
  monodromy << steps.omega().asDiagonal() * x.q, x.v;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(monodromy);
  Eigen::Index worst = 0;
  const double modulus = solver.eigenvalues().cwiseAbs().maxCoeff(&worst);
  const Eigen::VectorXcd u = solver.eigenvectors().col(worst);
  const double displacement = u.head(m).cwiseQuotient(steps.omega()).norm();
  return {std::log(modulus) / rotation, u.tail(m).norm() / displacement / (2.0 * pi)};
}

}  // namespace

RotationGrowth rotation_growth(const Disc& disc, const SquealOptions& options, double speed)
{
  const RotationGrowth coarse = growth_by(steps_per_period, disc, options, speed);
  RotationGrowth fine = growth_by(2 * steps_per_period, disc, options, speed);
  fine.growth += (fine.growth - coarse.growth) / 3.0;
  return fine;
}

RotationStability rotation_stability(const Disc& disc, const SquealOptions& options,
                                     unsigned n_threads)
{
  const SpeedRange& range = options.study.speeds;
  RotationStability result{Eigen::VectorXd::LinSpaced(range.count, range.from, range.to),
                           Eigen::VectorXd(range.count), Eigen::VectorXd(range.count),
                           std::nullopt};
  for_each_index(
      range.count,
      [&](int i) {
        const RotationGrowth at = rotation_growth(disc, options, result.speeds[i]);
        result.growth[i] = at.growth;
        result.frequency_Hz[i] = at.frequency_Hz;
      },
      n_threads);
  const auto growth = [&](double speed) { return rotation_growth(disc, options, speed).growth; };
  for (int i = 1; i < range.count && !result.critical_speed; ++i)
    if (result.growth[i - 1] < 0.0 && result.growth[i] > 0.0)
      result.critical_speed = root(growth, result.speeds[i - 1], result.speeds[i], speed_error);
  return result;
}

Stability stability_of(const RotationStability& rotation)
{
  if (rotation.critical_speed) return Stability::lost;
  if ((rotation.growth.array() > 0.0).all()) return Stability::unstable;
  return (rotation.growth.array() > 0.0).any() ? Stability::regained : Stability::stable;
}

}  // namespace chladni::squeal
