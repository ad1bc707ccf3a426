#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "common/error.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/numerics.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/stability_map.hpp"
#include "squeal/stability/stability_search.hpp"
#include "squeal/study/study.hpp"
#include "squeal/transient/spectrum.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using files::test::ScratchFolder;

/// Two pairs whose free vibrations decay by 1 1/s.
Disc lightly_damped_disc()
{
  auto body = analytic_body({kirchhoff_2(), kirchhoff_3()});
  body.C = 2.0 * Eigen::Matrix4d::Identity();
  return disc_on_ring(body, "track", {});
}

TEST(HopfPoint, IsTheCriticalSpeedOfTheReference)
{
  // SQUEAL reference values, 10 digits: 4.2718984074 pi at 1772.09545757 Hz.
  const InertialDisc disc = inertial_disc(disc_of({kirchhoff_3()}));
  const SquealOptions options = reference_options();
  const auto A = [&](double speed) { return state_matrix(disc, options, speed); };
  const Eigen::VectorXcd rough = Eigen::Vector4cd(1.0, {0.0, 0.5}, {0.0, 1.0}, -0.5);
  const auto point = hopf_point(A, 4.5 * pi, 2.0 * pi * 1773.0, rough);
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->value, 4.271898407362968 * pi, 1e-10 * pi);
  EXPECT_NEAR(point->omega, 2.0 * pi * 1772.0954575721983, 1e-6);
  EXPECT_LE(point->n_newton_steps, 8);
  const std::complex<double> i_omega(0.0, point->omega);
  EXPECT_LT((A(point->value) * point->u - i_omega * point->u).norm(), 1e-9 * point->omega);
}

TEST(CriticalValue, DividesStableFromUnstable)
{
  // Without damping both what drives the pair and what brakes it are proportional to friction; with
  // damping of the modes friction and stiffness decide. Newton's value is a border of the sign of
  // the growth, to rounding.
  const FlexibleDisc brake(lightly_damped_disc(), reference_options());
  const double speed = 6.0 * pi;
  for (const auto& [parameter, from, to] :
       {std::tuple{MapParameter::friction, 0.05, 1.0}, {MapParameter::stiffness, 1e5, 6e6}}) {
    const CriticalValue found =
        critical_value(brake, {.parameter = parameter, .from = from, .to = to, .speed = speed});
    ASSERT_TRUE(found.value) << found.parameter;
    const auto growth = [&, varied = parameter](double value) {
      return least_stable_eigenvalue(brake.with(varied, value)->state_matrix(speed)).real();
    };
    EXPECT_LT(growth(*found.value * (1.0 - 1e-7)) * growth(*found.value * (1.0 + 1e-7)), 0.0);
    EXPECT_NEAR(growth(*found.value), 0.0, 1e-8);  // 1e-12 of omega
    EXPECT_GT(found.frequency_Hz, 500.0);
  }
}

TEST(CriticalValue, IsAbsentWhereStabilityDoesNotChange)
{
  const FlexibleDisc brake(disc_of({kirchhoff_3()}), reference_options());
  const CriticalValue found = critical_value(
      brake, {.parameter = MapParameter::friction, .from = 0.5, .to = 0.7, .speed = 8.0 * pi});
  EXPECT_FALSE(found.value);
}

TEST(ModeShapes, AreEigenvectorsOfTheSlidingDisc)
{
  // The rates follow from the shape, p = (lambda + Omega D) a; the residual of the second half of
  // A x = lambda x is that of an eigenvector, rounding times the size of A.
  const Disc body = disc_of({kirchhoff_2(), kirchhoff_3()});
  const InertialDisc disc = inertial_disc(body);
  SquealOptions options = reference_options();
  options.study.speeds.count = 3;
  const EigenvalueMap map = eigenvalues(at_speeds(disc, options), options.study.speeds);
  const auto shapes = mode_shapes(disc, options, map);
  ASSERT_EQ(shapes.size(), 3u);
  const Eigen::MatrixXd A = state_matrix(disc, options, map.speeds[2]);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const Eigen::VectorXcd a = disc.R.transpose() * shapes[2].col(j);
    Eigen::VectorXcd x(8);
    x << disc.omega.cwiseProduct(a.real()) +
             std::complex<double>(0, 1) * disc.omega.cwiseProduct(a.imag()),
        map.lambda(2, j) * a + map.speeds[2] * (disc.D * a);
    EXPECT_LT((A * x - map.lambda(2, j) * x).norm(), 1e-10 * std::abs(map.lambda(2, j)) * x.norm());
    EXPECT_NEAR(shapes[2].col(j).norm(), 1.0, 1e-12);
  }
}

TEST(LimitCycleDirect, BalancesItsEnergy)
{
  // Work of all sources over a period sums to zero. 128 samples of powers with kinks leave about
  // 1e-4 of the largest; friction puts in what the modes' damping takes.
  for (const ContactLaw law : {ContactLaw::bilateral, ContactLaw::unilateral}) {
    auto body = analytic_body({kirchhoff_3()});
    body.C = 0.5 * Eigen::Matrix2d::Identity();
    SquealOptions options = reference_options(law);
    options.pads.push_back({.angle = 2.0, .stiffness = 3e6, .damping = 0.2, .preload = 1000.0});
    const CycleEnergy energy =
        limit_cycle_direct(FlexibleDisc(disc_on_ring(body, "track", {}), options), 10.0 * pi)
            .energy;
    ASSERT_EQ(energy.friction.size(), 2);
    const double sum = energy.friction.sum() + energy.normal.sum() + energy.damping;
    const double largest =
        std::max(energy.friction.cwiseAbs().maxCoeff(), energy.normal.cwiseAbs().maxCoeff());
    EXPECT_LT(std::abs(sum), 2e-3 * largest);
    EXPECT_LT(energy.damping, 0.0);
    // Damping of 0.5 1/s takes c T of twice the kinetic energy, half of what is stored twice.
    const double period = 1.0 / 1774.0;
    EXPECT_NEAR(energy.damping, -0.5 * period * energy.stored, 0.03 * 0.5 * period * energy.stored);
    EXPECT_GT(energy.heat.minCoeff(), 0.0);
  }
}

/// The body with its ring at 960 nodes, whose shapes are interpolated linearly between `n_coarse`
/// of them.
mbs_export::ModalBody linearly_interpolated(mbs_export::ModalBody body, Eigen::Index n_coarse)
{
  constexpr Eigen::Index n_fine = 960;
  mbs_export::ContactRing& ring = body.rings[0];
  const Disc exact = disc_on_ring(body, "track", {});
  const Eigen::Index part = n_fine / n_coarse;
  ring.angles = Eigen::VectorXd::LinSpaced(n_fine, 0.0, 2.0 * pi * (1.0 - 1.0 / n_fine));
  Eigen::MatrixXd W(n_fine, exact.n_modes()), W_r = W, W_t = W;
  for (Eigen::Index i = 0; i < n_fine; ++i) {
    const double x = double(i % part) / double(part);
    const Shapes left = shapes_at(exact, ring.angles[i - i % part]);
    const Shapes right = shapes_at(exact, ring.angles[(i - i % part + part) % n_fine]);
    W.row(i) = ((1.0 - x) * left.W + x * right.W).transpose();
    W_r.row(i) = ((1.0 - x) * left.W_r + x * right.W_r).transpose();
    W_t.row(i) = ((1.0 - x) * left.W_t + x * right.W_t).transpose();
  }
  ring.W = W;
  ring.W_r = W_r;
  ring.W_t = W_t;
  return body;
}

TEST(RingShapes, InterpolatedLinearlyWouldFalsifyTheGrowth)
{
  // At 6 pi the eigenvalue is 2.77597 1/s, which trigonometric interpolation keeps to the error of
  // the step. What linear interpolation adds falls with the square of the distance of the nodes.
  const auto rate = [](const mbs_export::ModalBody& body) {
    const TransientCase run{.speed = 6.0 * pi,
                            .duration = 2.0,
                            .initial_pad_displacement = 1e-8,
                            .steps_per_period = 40,
                            .integrator = IntegratorKind::splitting};
    return transient(FlexibleDisc(disc_on_ring(body, "track", {}), reference_options()), run)
        .growth_rate.value();
  };
  const mbs_export::ModalBody body = analytic_body({kirchhoff_3(1672.13)});
  const double exact = rate(body);
  const double coarse = rate(linearly_interpolated(body, 60)) - exact;
  const double fine = rate(linearly_interpolated(body, 120)) - exact;
  EXPECT_NEAR(exact, 2.77597, 3e-4);
  EXPECT_GT(coarse, 0.015);
  EXPECT_NEAR(coarse / fine, 4.0, 0.8);
}

TEST(StabilityMap, DoesNotDependOnTheNumberOfThreads)
{
  SquealOptions options = reference_options();
  options.study.speeds.count = 7;
  options.study.map =
      MapCase{.parameter = MapParameter::friction, .from = 0.1, .to = 0.9, .count = 5};
  const FlexibleDisc brake(disc_of({kirchhoff_2(), kirchhoff_3()}), options);
  const auto on_threads = [&](unsigned n) {
    return stability_map(brake, *options.study.map, options.study.speeds, n);
  };
  const StabilityMap one = on_threads(1), three = on_threads(3);
  EXPECT_EQ(one.growth, three.growth);
  EXPECT_EQ(one.frequency_Hz, three.frequency_Hz);
}

TEST(ForEachIndex, VisitsEachOnceAndRethrows)
{
  for (const unsigned n_threads : {1U, 2U, 5U}) {
    std::vector<int> visits(17, 0);
    for_each_index(
        17, [&](int i) { ++visits[static_cast<std::size_t>(i)]; }, n_threads);
    EXPECT_EQ(visits, std::vector<int>(17, 1));
    EXPECT_THROW(for_each_index(
                     3,
                     [](int i) {
                       if (i == 2) throw Error("two");
                     },
                     n_threads),
                 Error);
  }
}

TEST(Run, KeepsWhatItHasWhenALaterAnalysisFails)
{
  // The transient is too short for a limit cycle.
  SquealOptions options = reference_options();
  options.study.speeds.count = 2;
  options.study.analyses = {"eigenvalues", "limit-cycle"};
  options.study.transient =
      TransientCase{.speed = 6.0 * pi, .duration = 0.001, .initial_pad_displacement = 1e-6};
  const SquealResults results = run(FlexibleDisc(disc_of({kirchhoff_3()}), options), options.study);
  EXPECT_TRUE(results.eigenvalues);
  EXPECT_TRUE(results.transient);
  EXPECT_FALSE(results.limit_cycle);
  ASSERT_TRUE(results.failure);
  EXPECT_NE(results.failure->find("too short"), std::string::npos);
  EXPECT_EQ(results.missing, std::vector<std::string>{"limit-cycle"});
}

TEST(Run, HandsOverWhatItHasBeforeEachAnalysisAndGoesOnFromThere)
{
  SquealOptions options = reference_options();
  options.study.speeds.count = 2;
  options.study.analyses = {"eigenvalues", "critical-speed", "limit-cycle"};
  options.study.transient =
      TransientCase{.speed = 6.0 * pi, .duration = 0.3, .initial_pad_displacement = 6e-4};
  const Disc disc = disc_of({kirchhoff_3()});
  std::vector<SquealResults> seen;
  const SquealResults whole =
      run(FlexibleDisc(disc, options), options.study,
          {.unfinished = [&](const SquealResults& results) { seen.push_back(results); }});
  EXPECT_TRUE(whole.missing.empty());
  ASSERT_EQ(seen.size(), 4u);
  const std::vector<std::string> all{"eigenvalues", "critical-speed", "transient", "limit-cycle"};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].missing,
              std::vector<std::string>(all.begin() + static_cast<std::ptrdiff_t>(i), all.end()));
  }
  EXPECT_TRUE(seen[2].critical_speed);
  EXPECT_FALSE(seen[2].transient);
  // Of the unfinished results it keeps what is there, marked here; the limit cycle needs more of
  // the transient than a file holds.
  seen[3].critical_speed->speed = 1.0;
  seen[3].transient->tail_a = {};
  const SquealResults resumed = run(FlexibleDisc(disc, options), options.study, {.begin = seen[3]});
  EXPECT_EQ(resumed.critical_speed->speed, 1.0);
  EXPECT_TRUE(resumed.missing.empty());
  ASSERT_TRUE(resumed.limit_cycle);
  ASSERT_EQ(resumed.limit_cycle->amplitude.size(), whole.limit_cycle->amplitude.size());
  EXPECT_EQ(resumed.limit_cycle->amplitude, whole.limit_cycle->amplitude);
}

TEST(Run, YieldsSpectrumSoundAndCriticalValues)
{
  SquealOptions options = reference_options();
  options.study.analyses = {"spectrum", "critical-values"};
  options.study.transient =
      TransientCase{.speed = 6.0 * pi, .duration = 1.2, .initial_pad_displacement = 6e-4};
  options.study.sound = SoundCase{.rate_Hz = 44100};
  options.study.critical = {
      {.parameter = MapParameter::friction, .from = 0.1, .to = 1.0, .speed = 5.0 * pi}};
  auto body = analytic_body({kirchhoff_3(1672.13)});
  body.C = 0.5 * Eigen::Matrix2d::Identity();
  const ScratchFolder folder;
  WavRecording sound(folder.file("disc.wav"), 44100);
  const SquealResults results =
      run(FlexibleDisc(disc_on_ring(body, "track", {}), options), options.study, {.sound = &sound});
  ASSERT_TRUE(results.spectrum && !results.spectrum->peaks.empty());
  EXPECT_NEAR(results.spectrum->peaks[0].frequency_Hz, 1696.85, 0.3);
  // 1.2 s of 16 bits, and the headers.
  EXPECT_NEAR(double(std::filesystem::file_size(folder.file("disc.wav"))), 2.0 * 52920.0, 200.0);
  // But for the ends, where the filter lacks samples.
  const double largest = std::ranges::max(results.transient->envelope.pad_velocity);
  EXPECT_NEAR(sound.full_scale().value_or(0.0), largest, 0.05 * largest);
  ASSERT_EQ(results.critical_values.size(), 1u);
  EXPECT_TRUE(results.critical_values[0].value);
}

}  // namespace
}  // namespace chladni::squeal
