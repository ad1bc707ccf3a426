// Every point is compared with the QR iteration.
#include "squeal/stability/stability_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Relative to |lambda|: the promise of the map. Rounding leaves 1e-14.
constexpr double tolerance = 1e-9;

/// The growth is the largest of the QR iteration and the value one of its eigenvalues; which one of
/// several with the same growth is not determined.
SequenceCount expect_as_qr(const MatrixOf& A, Index n)
{
  const LeastStableSequence sequence = least_stable_eigenvalues(A, n);
  for (Index i = 0; i < n; ++i) {
    const Eigen::VectorXcd all = oscillating_eigenvalues(A(i));
    const std::complex<double> lambda = sequence.lambda[i];
    EXPECT_NEAR(lambda.real(), all.real().maxCoeff(), tolerance * std::abs(lambda)) << "at " << i;
    EXPECT_LT((all.array() - lambda).abs().minCoeff(), tolerance * std::abs(lambda)) << "at " << i;
  }
  EXPECT_EQ(sequence.count.by_discs + sequence.count.by_qr, n);
  return sequence.count;
}

constexpr MapCase over_friction{MapParameter::friction, 0.1, 1.0, 16};
constexpr MapCase over_preload{MapParameter::preload, 500.0, 4e3, 16};
constexpr MapCase over_stiffness{MapParameter::stiffness, 2e6, 1e7, 16};

/// All points at three speeds.
SequenceCount expect_map_as_qr(const Disc& disc, const SquealOptions& options, const MapCase& map)
{
  const FlexibleDisc brake(disc, options);
  const VectorXd values = VectorXd::LinSpaced(map.count, map.from, map.to);
  SequenceCount total{};
  for (const double speed : {pi, 6.0 * pi, 20.0 * pi}) {
    const SequenceCount count = expect_as_qr(
        [&](Index i) { return brake.with(map.parameter, values[i])->state_matrix(speed); },
        map.count);
    total.by_discs += count.by_discs;
    total.by_qr += count.by_qr;
  }
  return total;
}

Disc disc_with_damping(double ratio)
{
  Disc disc = disc_of(kirchhoff_modes());
  disc.C = (2.0 * ratio * disc.omega).asDiagonal();
  return disc;
}

TEST(ColumnEigenvalues, OfThirtyFiveModesAreThoseOfTheQrIteration)
{
  for (const double ratio : {0.0, 1e-4})
    for (const MapCase& map : {over_friction, over_preload, over_stiffness})
      // The QR iteration starts each of the three columns, and no more.
      EXPECT_EQ(expect_map_as_qr(disc_with_damping(ratio), reference_options(), map).by_qr, 3);
}

// Without friction nothing grows: all real parts of the undamped disc are rounding errors.
TEST(ColumnEigenvalues, OfUndampedModesThatDoNotGrowAreThoseOfTheQrIteration)
{
  SquealOptions options = reference_options();
  const MapCase little{MapParameter::friction, 0.0, 1e-3, 16};
  EXPECT_EQ(expect_map_as_qr(disc_with_damping(0.0), options, little).by_qr, 3);
  options.friction.kinetic = 0.0;
  EXPECT_EQ(expect_map_as_qr(disc_with_damping(0.0), options, over_stiffness).by_qr, 3);
}

TEST(ColumnEigenvalues, WithSeveralContactPointsAreThoseOfTheQrIteration)
{
  SquealOptions pads = reference_options();
  pads.pads.push_back({.angle = 1.1, .stiffness = 4e6, .damping = 20.0, .preload = 1500.0});
  SquealOptions grid = reference_options();
  grid.pads[0].grid = PadGrid{.sector = 0.7, .points = 4};
  for (const SquealOptions& options : {pads, grid})
    for (const MapCase& map : {over_friction, over_stiffness})
      EXPECT_EQ(expect_map_as_qr(disc_with_damping(0.0), options, map).by_qr, 3);
}

TEST(ColumnEigenvalues, WithPadsThatHaveAMassAreThoseOfTheQrIteration)
{
  SquealOptions options = reference_options();
  options.pads[0].body = PadBody{.mass = 0.3,
                                 .height = 0.01,
                                 .radial = Suspension{3e7, 20.0},
                                 .tangential = Suspension{2e7, 20.0},
                                 .axial = Suspension{5e6, 30.0}};
  for (const MapCase& map : {over_friction, over_preload, over_stiffness})
    EXPECT_GT(expect_map_as_qr(disc_with_damping(0.0), options, map).by_discs, 24);
}

TEST(ColumnEigenvalues, WithModesWithoutInertiaAreThoseOfTheQrIteration)
{
  std::vector<PlatePair> pairs = kirchhoff_modes();
  for (int n = 0; n < 8; ++n) {
    pairs.push_back({.n = n,
                     .f_Hz = 60e3 + 12e3 * n,
                     .mass = 0.1 / 9.0,
                     .U = 0.5 + 0.1 * n,
                     .U_r = 9.0 - 3.0 * n,
                     .U_t = n * 4.1});
  }
  mbs_export::ModalBody body = analytic_body(pairs);
  for (std::size_t i = 35; i < body.kinds.size(); ++i)
    body.kinds[i] = mbs_export::ModeKind::interface;
  const Disc disc = disc_on_ring(body, "track", {.quasi_static_above = 2.0 * pi * 30e3});
  ASSERT_FALSE(disc.compliance.empty());
  for (const MapCase& map : {over_friction, over_stiffness})
    EXPECT_EQ(expect_map_as_qr(disc, reference_options(), map).by_qr, 3);
}

TEST(ColumnEigenvalues, OnSeveralThreadsAreThoseOnOne)
{
  const FlexibleDisc brake(disc_with_damping(0.0), reference_options());
  const SpeedRange speeds{.from = pi, .to = 20.0 * pi, .count = 5};
  const StabilityMap one = stability_map(brake, over_friction, speeds, 1);
  const StabilityMap three = stability_map(brake, over_friction, speeds, 3);
  EXPECT_EQ(one.growth, three.growth);
  EXPECT_EQ(one.frequency_Hz, three.frequency_Hz);
}

/// [2 n x 2 n] of x'' + C x' + K x = 0 for x = (omega q, q').
MatrixXd oscillators(const VectorXd& omega, const MatrixXd& C, const MatrixXd& K_more)
{
  const Index n = omega.size();
  MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);
  A.topRightCorner(n, n) = omega.asDiagonal();
  A.bottomLeftCorner(n, n) = -MatrixXd(omega.asDiagonal());
  A.bottomLeftCorner(n, n) -= K_more * omega.cwiseInverse().asDiagonal();
  A.bottomRightCorner(n, n) = -C;
  return A;
}

constexpr Index n_oscillators = 14;

TEST(ColumnEigenvalues, OfExactlyMultipleFrequenciesAreThoseOfTheQrIteration)
{
  VectorXd omega(n_oscillators), shape(n_oscillators), other(n_oscillators);
  for (Index i = 0; i < n_oscillators; ++i) {
    const Index four = i / 4;
    omega[i] = 4e3 + 1e3 * double(four);
    shape[i] = std::sin(1.0 + double(i));
    other[i] = std::cos(0.3 * double(i));
  }
  // No disc is apart from the others about a multiple eigenvalue: the QR iteration has to decide.
  for (const double damping : {0.0, 2.0}) {
    const auto A = [&](Index i) {
      const MatrixXd C = damping * MatrixXd::Identity(n_oscillators, n_oscillators);
      return oscillators(omega, C, 1e5 * double(i) * shape * (shape + other).transpose());
    };
    EXPECT_EQ(expect_as_qr(A, 30).by_qr, 30);
  }
}

/// The stiffness of the first oscillator rises through that of the second at i = 12 exactly; its
/// damping differs by `step`, and `coupling` makes one pair flutter or veer.
MatrixXd crossing(Index i, double step, double coupling)
{
  const VectorXd omega = VectorXd::LinSpaced(n_oscillators, 4e3, 4e3 + 250.0 * (n_oscillators - 1));
  VectorXd c = VectorXd::Constant(n_oscillators, 5.0);
  c[0] = 1.0;
  c[1] = 1.0 + step * double(i - 12);  // the least stable one changes there
  MatrixXd K = MatrixXd::Zero(n_oscillators, n_oscillators);
  K(0, 0) = (omega[1] * omega[1] - omega[0] * omega[0]) * double(i) / 12.0;
  K(0, 1) = std::abs(coupling);
  K(1, 0) = coupling;
  return oscillators(omega, c.asDiagonal(), K);
}

TEST(ColumnEigenvalues, WhereBranchesCrossAreThoseOfTheQrIteration)
{
  for (const double step : {0.0, 0.05, -0.05})
    for (const double coupling : {0.0, 1e3, 1e5, -1e3, -1e5}) {
      EXPECT_GE(expect_as_qr([&](Index i) { return crossing(i, step, coupling); }, 30).by_discs,
                26);
    }
}

TEST(ColumnEigenvalues, AfterAJumpOfTheParameterAreThoseOfTheQrIteration)
{
  const auto A = [](Index i) { return crossing(i < 15 ? i : 100 * i, 0.05, -1e5); };
  EXPECT_GE(expect_as_qr(A, 30).by_discs, 25);
}

TEST(ColumnEigenvalues, OfOverdampedMotionsAndOfChangesOfFullRankComeFromTheQrIteration)
{
  VectorXd omega = VectorXd::LinSpaced(n_oscillators, 4e3, 9e3), c = VectorXd::Ones(n_oscillators);
  const MatrixXd none = MatrixXd::Zero(n_oscillators, n_oscillators);
  EXPECT_EQ(expect_as_qr(
                [&](Index i) {
                  return oscillators(omega * (1.0 + 0.01 * double(i)), c.asDiagonal(), none);
                },
                12)
                .by_qr,
            12);
  c[3] = 1e5;
  EXPECT_EQ(expect_as_qr(
                [&](Index i) {
                  c[0] = 1.0 + double(i);
                  return oscillators(omega, c.asDiagonal(), none);
                },
                12)
                .by_qr,
            12);
}

struct Changed {
  MatrixXd A;
  LowRankChange change;
  PoleSum sum;
};

Changed changed_by(Index i, double step)
{
  const MatrixXd A_0 = crossing(0, step, -1e4), A = crossing(i, step, -1e4);
  const auto change = LowRankChange::about(A_0, {A});
  return {A, change.value(), change.value().sum_of(A).value()};
}

TEST(EigenvalueDiscs, FindNothingWhereTheSumOfTheEigenvaluesIsNotTheTrace)
{
  const Changed c = changed_by(6, 0.05);
  const Eigen::VectorXcd all = matched(oscillating_eigenvalues(c.A), c.change.poles());
  EXPECT_TRUE(least_stable_in_discs(c.sum, c.change.poles(), all, c.A.trace()));
  EXPECT_FALSE(least_stable_in_discs(c.sum, c.change.poles(), all, c.A.trace() + 1e-5));
}

// Two discs that meet hold two eigenvalues between them, and a chain of discs may reach far.
TEST(EigenvalueDiscs, FindNothingWhereTheDiscOfTheRightmostMeetsAnother)
{
  VectorXd omega = VectorXd::LinSpaced(n_oscillators, 4e3, 7e3);
  VectorXd c = VectorXd::Constant(n_oscillators, 5.0);
  c.head(2).setOnes();
  const MatrixXd none = MatrixXd::Zero(n_oscillators, n_oscillators);
  const double both = 4.1e3;  // rad/s
  MatrixXd K = none;
  for (Index i = 0; i < 2; ++i) K(i, i) = both * both - omega[i] * omega[i];
  const MatrixXd A_0 = oscillators(omega, c.asDiagonal(), none);
  const MatrixXd A = oscillators(omega, c.asDiagonal(), K);
  const LowRankChange change = LowRankChange::about(A_0, {A}).value();
  Eigen::VectorXcd start = matched(oscillating_eigenvalues(A), change.poles());
  Index i = 0;
  start.real().maxCoeff(&i);
  start[i] += 1e-12 * both;
  EXPECT_FALSE(least_stable_in_discs(change.sum_of(A).value(), change.poles(), start, A.trace()));
}

// All values are eigenvalues, but one that is not the rightmost stands twice, or the rightmost is
// far away: corrections of the others alone would not show it.
TEST(EigenvalueDiscs, DoNotLoseTheRightmostFromWrongApproximations)
{
  const Changed c = changed_by(6, 0.05);
  const Eigen::VectorXcd all = oscillating_eigenvalues(c.A);
  const Eigen::VectorXcd right = matched(all, c.change.poles());
  Index worst = 0;
  const double growth = right.real().maxCoeff(&worst);
  for (const double shift : {0.0, 1e-3, 1.0, 30.0, 1e3}) {
    Eigen::VectorXcd start = right;
    start[worst] = right[worst == 0 ? 1 : 0] + shift;
    const auto found = least_stable_in_discs(c.sum, c.change.poles(), start, c.A.trace());
    if (!found) continue;
    EXPECT_NEAR(found->lambda.real(), growth, tolerance * std::abs(found->lambda));
  }
}

}  // namespace
}  // namespace chladni::squeal
