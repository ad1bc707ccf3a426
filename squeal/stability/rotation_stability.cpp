#include "squeal/stability/rotation_stability.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/motion/splitting.hpp"
#include "squeal/numerics.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/hill.hpp"

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
        shapes_(disc),
        brake_(free_brake(disc, pads_, 0.0)),
        G_(Eigen::MatrixXd::Zero(brake_.omega.size(), brake_.omega.size())),
        flow_(brake_.omega, brake_.C, 0.5 * step)
  {
    G_.topLeftCorner(disc.n_modes(), disc.n_modes()) = disc.G;
    contact_ = contact_at_rest(pads_, brake_.omega.size(), speed);
    rows_ = pads_.rows();
    for (std::size_t i = 0; i < pads_.points.size(); ++i) {
      const PointPair& point = pads_.points[i];
      contact_.S.middleCols(rows_ * static_cast<Eigen::Index>(i), rows_) =
          pair_shapes(shapes_.at(point, 0.0), pads_, point);
    }
    ContactSeries(disc.compliance, pads_, speed).condense(contact_);
  }

  const Eigen::VectorXd& omega() const { return brake_.omega; }

  /// Half a flow, the kick of the pads in the middle by the explicit midpoint rule, half a flow.
  void advance(ModalColumns& x, double t_middle)
  {
    flow_.advance(x);
    const double angle = speed_ * t_middle;
    for (std::size_t i = 0; i < pads_.points.size(); ++i) {
      const PointPair& point = pads_.points[i];
      const Eigen::MatrixXd& S = shapes_.at(point, angle);
      contact_.S.block(0, rows_ * static_cast<Eigen::Index>(i), S.rows(), S.cols()) = S;
    }
    x.v += step_ * force(x.q, x.v + 0.5 * step_ * force(x.q, x.v));
    flow_.advance(x);
  }

 private:
  Eigen::MatrixXd force(const Eigen::MatrixXd& q, const Eigen::MatrixXd& v) const
  {
    Eigen::MatrixXd F = -2.0 * speed_ * (G_ * v);
    const Eigen::MatrixXd& S = contact_.S;
    const Eigen::MatrixXd at_points =
        contact_.D_a * (S.transpose() * q) + contact_.D_p * (S.transpose() * v);
    F.noalias() += S * at_points;
    return F;
  }

  double speed_, step_;
  PadSystem pads_;
  PointShapes shapes_;
  FreeBrake brake_;
  Eigen::MatrixXd G_;
  OscillatorFlow flow_;
  StackedContact contact_;
  Eigen::Index rows_ = 0;  ///< of a point
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

namespace {

/// Exponents that are told at each speed.
constexpr Eigen::Index n_worst = 5;

RotationStability empty_stability(const Disc& disc, const SquealOptions& options)
{
  const SpeedRange& range = options.study.speeds;
  const bool hill = options.study.rotation_method == RotationMethod::hill;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(range.count);
  RotationStability result{Eigen::VectorXd::LinSpaced(range.count, range.from, range.to), zero,
                           zero, std::nullopt};
  result.method = hill ? "hill" : "floquet";
  result.frozen_growth = zero;
  if (hill) result.exponents.resize(range.count, std::min(n_worst, disc.n_modes()));
  return result;
}

}  // namespace

RotationStability rotation_stability(const Disc& disc, const SquealOptions& options,
                                     unsigned n_threads)
{
  const Hill hill(disc, options);
  const bool by_hill = options.study.rotation_method == RotationMethod::hill;
  RotationStability result = empty_stability(disc, options);
  const int n = options.study.speeds.count;
  std::vector<HillExponents> exponents(static_cast<std::size_t>(by_hill ? n : 0));
  for_each_index(
      n,
      [&](int i) {
        const double speed = result.speeds[i];
        if (by_hill) {
          HillExponents& at = exponents[static_cast<std::size_t>(i)];
          at = hill.exponents(speed, n_worst);
          result.frozen_growth[i] = hill.frozen_growth(speed, at.nu);
          return;
        }
        result.frozen_growth[i] = hill.frozen_growth(speed, hill.nu(speed));
        const RotationGrowth at = rotation_growth(disc, options, result.speeds[i]);
        result.growth[i] = at.growth;
        result.frequency_Hz[i] = at.frequency_Hz;
      },
      n_threads);
  for (std::size_t k = 0; k < exponents.size(); ++k) {
    const HillExponents& at = exponents[k];
    const auto i = static_cast<Eigen::Index>(k);
    result.growth[i] = at.lambda[0].real();
    result.frequency_Hz[i] = at.lambda[0].imag() / (2.0 * pi);
    result.exponents.row(i) = at.lambda.head(result.exponents.cols()).transpose();
    result.harmonics = std::max(result.harmonics, at.harmonics);
    result.error = std::max(result.error, at.error);
  }
  // Growth within its own error is none: the search would only follow what the errors do.
  const auto growth = [&](double speed) {
    if (!by_hill) return rotation_growth(disc, options, speed).growth;
    const HillExponents at = hill.exponents(speed, n_worst);
    const double largest = at.lambda[0].real();
    return std::abs(largest) <= at.error ? 0.0 : largest;
  };
  for (int i = 1; i < n && !result.critical_speed; ++i)
    if (result.growth[i - 1] < 0.0 && result.growth[i] > 0.0)
      result.critical_speed = root(growth, result.speeds[i - 1], result.speeds[i], speed_error);
  return result;
}

TurningEigenvalues turning_eigenvalues(const Disc& disc, const SquealOptions& options)
{
  const Hill hill(disc, options);
  const SpeedRange& range = options.study.speeds;
  const Eigen::VectorXd speeds = Eigen::VectorXd::LinSpaced(range.count, range.from, range.to);
  std::vector<Eigen::MatrixXd> mean(static_cast<std::size_t>(range.count));
  std::vector<FrozenDisc> frozen(mean.size());
  for_each_index(range.count, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    mean[at] = hill.mean_matrix(speeds[i]);
    frozen[at] = hill.worst_frozen(speeds[i], hill.nu(speeds[i]));
  });
  const auto at_speed = [&](double speed) {
    Eigen::Index i = 0;
    (speeds.array() - speed).abs().minCoeff(&i);
    return static_cast<std::size_t>(i);
  };
  TurningEigenvalues found{
      eigenvalues([&](double speed) { return mean[at_speed(speed)]; }, range),
      eigenvalues([&](double speed) { return frozen[at_speed(speed)].A; }, range)};
  found.mean.of = "mean matrix";
  found.frozen.of = "worst frozen angle";
  found.frozen.angles = speeds;
  for (std::size_t i = 0; i < frozen.size(); ++i)
    found.frozen.angles[static_cast<Eigen::Index>(i)] = frozen[i].angle;
  return found;
}

Stability stability_of(const RotationStability& rotation)
{
  if (rotation.critical_speed) return Stability::lost;
  if ((rotation.growth.array() > 0.0).all()) return Stability::unstable;
  return (rotation.growth.array() > 0.0).any() ? Stability::regained : Stability::stable;
}

}  // namespace chladni::squeal
