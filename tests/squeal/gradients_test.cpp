#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/sensitivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "common/error.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/models/parameters.hpp"
#include "squeal/models/rigid_disc.hpp"
#include "squeal/models/sliding_masses.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/hill.hpp"
#include "squeal/stability/hill_table.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/squeal/turning_discs.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using Complex = std::complex<double>;

/// Two pairs of pads with all that pads can have, on three pairs of modes with damping.
SquealOptions rich_options()
{
  SquealOptions options = reference_options();
  options.friction = {.kinetic = 0.5, .rise = 0.1, .decay_speed = 2.0, .regularisation = 1e-2};
  PadPair& plate = options.pads.front();
  plate.damping = 5.0;
  plate.grid = PadGrid{.sector = 0.4, .points = 3};
  plate.body = PadBody{.mass = 0.3,
                       .height = 0.01,
                       .radial = Suspension{3e7, 20.0},
                       .tangential = Suspension{2e8, 200.0},
                       .axial = Suspension{5e6, 30.0},
                       .about_tangential = RotarySuspension{1e-4, {2e3, 0.05}}};
  plate.caliper = Caliper{.mass = 3.0, .axial = {4e6, 10.0}};
  plate.shim = Shim{.stiffness = 4e7, .loss_factor = 0.1, .frequency_Hz = 1700.0};
  const FrictionTable table{.temperatures = {100.0, 300.0},
                            .pressures = {2e5, 1e6, 2e6},
                            .curves = {friction_curve({0.01, 3.0, 12.0}, {0.5, 0.47, 0.44}),
                                       friction_curve({0.01, 3.0, 12.0}, {0.49, 0.46, 0.43}),
                                       friction_curve({0.01, 3.0, 12.0}, {0.48, 0.44, 0.41}),
                                       friction_curve({0.01, 3.0, 12.0}, {0.45, 0.43, 0.41}),
                                       friction_curve({0.01, 3.0, 12.0}, {0.44, 0.42, 0.4}),
                                       friction_curve({0.01, 3.0, 12.0}, {0.43, 0.4, 0.38})}};
  PadPair light{.angle = 2.0, .stiffness = 5e6, .damping = 0.0, .preload = 1500.0};
  light.friction = FrictionLaw{
      .kinetic = 1.0, .table = std::make_shared<const FrictionTable>(table), .temperature = 170.0};
  light.area = 2e-3;
  options.pads.push_back(light);
  options.study.speeds = {.from = 2.0, .to = 80.0, .count = 60};
  return options;
}

Disc damped_disc()
{
  auto body = analytic_body({kirchhoff_2(), kirchhoff_3(), kirchhoff_4()});
  body.C = (2.0 * 2e-4 * body.omega).asDiagonal();
  return disc_on_ring(body, "track", {});
}

/// The growth of the eigenvalue nearest to one of a neighbouring brake.
double growth_near(const Eigen::MatrixXd& A, const Complex& lambda)
{
  const Eigen::VectorXcd all = A.eigenvalues();
  Eigen::Index at = 0;
  (all.array() - lambda).abs().minCoeff(&at);
  return all[at].real();
}

/// Where the growth of the critical oscillation vanishes, near the critical speed of a neighbouring
/// brake: the secant rule.
double critical_speed_near(const StateMatrixAt& A, const Gradients& known)
{
  const Complex lambda(0.0, 2.0 * pi * *known.critical_frequency_Hz);
  const auto growth = [&](double speed) { return growth_near(A(speed), lambda); };
  double last = *known.critical_speed, at = last * (1.0 + 1e-4);
  double f_last = growth(last), f_at = growth(at);
  for (int i = 0; i < 8 && f_at != f_last; ++i) {
    const double next = at - f_at * (at - last) / (f_at - f_last);
    last = at;
    f_last = f_at;
    at = next;
    f_at = growth(at);
  }
  return at;
}

Complex eigenvalue_of(const GradientMotion& motion)
{
  return {motion.growth, 2.0 * pi * motion.frequency_Hz};
}

/// Central differences of a function of second and fourth order, and how far they are apart.
struct Difference {
  double value, doubt;
};
template <class Function>
Difference difference(const Function& f, double x)
{
  const double h = 1e-4 * std::abs(x);
  const double near = (f(x + h) - f(x - h)) / (2.0 * h);
  const double far = (f(x + 2.0 * h) - f(x - 2.0 * h)) / (4.0 * h);
  return {(4.0 * near - far) / 3.0, std::abs(near - far)};
}

void expect_derivatives(const Brake& brake, const StudyOptions& options)
{
  const Gradients found = gradients(brake, options);
  const auto parameters = brake.parameters();
  ASSERT_GT(parameters.size(), 3u);
  for (const auto& [parameter, value] : parameters) {
    const std::string key = key_of(parameter);
    const auto row = std::ranges::find(found.rows, key, &GradientRow::key);
    ASSERT_NE(row, found.rows.end()) << key;
    EXPECT_EQ(row->value, value) << key;
    if (value == 0.0) continue;  // the next test
    const auto with = [&, parameter = parameter](double x) { return brake.with(parameter, x); };
    if (found.critical_speed) {
      const Difference by_value = difference(
          [&](double x) {
            const auto changed = with(x);
            return critical_speed_near(state_matrix_at(*changed), found);
          },
          value);
      // Of the search: 1e-12 of the speed over a step of 1e-4 of the value.
      const double rounding = 1e-7 * *found.critical_speed / std::abs(value);
      EXPECT_NEAR(*row->critical_speed, by_value.value,
                  1e-6 * std::abs(by_value.value) + by_value.doubt + rounding)
          << key;
    }
    for (std::size_t i = 0; i < found.motions.size(); ++i) {
      const Complex lambda = eigenvalue_of(found.motions[i]);
      const Difference by_value = difference(
          [&](double x) { return growth_near(with(x)->state_matrix(*found.speed), lambda); },
          value);
      const double rounding = 1e-9 * std::abs(lambda) / std::abs(value);
      EXPECT_NEAR(row->growth[Eigen::Index(i)], by_value.value,
                  1e-6 * std::abs(by_value.value) + by_value.doubt + rounding)
          << key << ", motion " << i;
    }
  }
}

TEST(Gradients, OfEveryParameterAreCentralDifferences)
{
  SquealOptions options = rich_options();
  const FlexibleDisc brake(damped_disc(), options);
  options.study.gradients = GradientCase{.speed = 40.0};
  ASSERT_TRUE(gradients(brake, options.study).critical_speed);
  expect_derivatives(brake, options.study);
}

TEST(Gradients, OfFrequenciesAreCentralDifferences)
{
  SquealOptions options = rich_options();
  const FlexibleDisc brake(damped_disc(), options);
  options.study.gradients = GradientCase{.speed = 40.0};
  const Gradients found = gradients(brake, options.study);
  const InertialDisc& disc = brake.inertial();
  for (Eigen::Index i = 0; i < disc.n_modes(); i += 2) {
    const double f_Hz = disc.omega[i] / (2.0 * pi);
    const auto row = std::ranges::find_if(found.rows, [&](const GradientRow& one) {
      return one.unit == "Hz" && one.value == f_Hz && one.key.starts_with("frequency of the pair");
    });
    ASSERT_NE(row, found.rows.end());
    const auto A = [&](double x, double speed) {
      InertialDisc changed = disc;
      changed.omega.segment(i, 2).setConstant(2.0 * pi * x);
      return state_matrix(changed, brake.options(), speed);
    };
    const Difference critical = difference(
        [&](double x) {
          const StateMatrixAt over = [&](double speed) { return A(x, speed); };
          return critical_speed_near(over, found);
        },
        f_Hz);
    EXPECT_NEAR(
        *row->critical_speed, critical.value,
        1e-6 * std::abs(critical.value) + critical.doubt + 1e-7 * *found.critical_speed / f_Hz);
    const Complex lambda = eigenvalue_of(found.motions[0]);
    const Difference growth =
        difference([&](double x) { return growth_near(A(x, 40.0), lambda); }, f_Hz);
    EXPECT_NEAR(row->growth[0], growth.value, 1e-6 * std::abs(growth.value) + growth.doubt + 1e-8);
  }
}

TEST(Gradients, OfModelsWithoutABodyAreCentralDifferences)
{
  const SlidingBrake oscillator(
      Oscillator{.mass = 1.0,
                 .k_x = 4.2e3,
                 .k_y = 3e3,
                 .k_xy = 8e2,
                 .d_x = 0.4,
                 .d_y = 0.3,
                 .contact_stiffness = 1.5e3,
                 .preload = 20.0,
                 .radius = 0.2,
                 .friction = {.kinetic = 0.4, .rise = 0.2, .decay_speed = 1.0},
                 .law = ContactLaw::bilateral});
  StudyOptions study{.speeds = {.from = 1.0, .to = 60.0, .count = 40}, .analyses = {}};
  study.gradients = GradientCase{.speed = 4.0};
  expect_derivatives(oscillator, study);
}

TEST(Gradients, OfAValueOfZeroAreOneSided)
{
  // The second pair has no damper: A is linear in it, so that a finite one gives the same.
  SquealOptions options = rich_options();
  const FlexibleDisc brake(damped_disc(), options);
  options.study.gradients = GradientCase{.speed = 40.0};
  const Gradients found = gradients(brake, options.study);
  const auto row = std::ranges::find(found.rows, "pads[2].damping", &GradientRow::key);
  ASSERT_NE(row, found.rows.end());
  EXPECT_EQ(row->value, 0.0);
  EXPECT_EQ(effect_of_usual_change(found, *row), 0.0);
  constexpr double h = 1e-2;
  const auto damped = brake.with({"damping", 2}, h), more = brake.with({"damping", 2}, 2.0 * h);
  const double at_0 = critical_speed_near(state_matrix_at(brake), found),
               at_h = critical_speed_near(state_matrix_at(*damped), found),
               at_2h = critical_speed_near(state_matrix_at(*more), found);
  const double difference = (4.0 * at_h - 3.0 * at_0 - at_2h) / (2.0 * h);
  EXPECT_NEAR(*row->critical_speed, difference, 1e-4 * std::abs(difference) + 1e-7);
}

TEST(Gradients, StandByFallingEffectOfOnePerCent)
{
  SquealOptions options = rich_options();
  const Gradients found = gradients(FlexibleDisc(damped_disc(), options), options.study);
  EXPECT_TRUE(found.motions.empty());
  for (std::size_t i = 1; i < found.rows.size(); ++i) {
    EXPECT_GE(effect_of_usual_change(found, found.rows[i - 1]),
              effect_of_usual_change(found, found.rows[i]));
  }
}

TEST(Gradients, WithoutACriticalSpeedNeedASpeed)
{
  SquealOptions options = rich_options();
  options.friction = {.kinetic = 1e-3};
  options.pads.pop_back();
  options.study.speeds = {.from = 10.0, .to = 11.0, .count = 3};
  const FlexibleDisc brake(damped_disc(), options);
  const std::string complaint = files::test::error_of([&] { gradients(brake, options.study); });
  EXPECT_NE(complaint.find("no critical speed within [squeal] speeds, 10 to 11 rad/s"),
            std::string::npos);
  options.study.gradients = GradientCase{.speed = 40.0};
  const Gradients found = gradients(brake, options.study);
  EXPECT_FALSE(found.critical_speed);
  EXPECT_EQ(found.motions.size(), 1u);  // stable: the least stable one alone
}

/// The critical speed of a disc that is not axisymmetric, near a known one, by the secant rule.
double turning_critical_speed_near(const FlexibleDisc& brake, double known)
{
  const Hill hill(brake.disc(), brake.options(), 1e-9);
  const auto growth = [&](double speed) { return hill.exponents(speed).lambda[0].real(); };
  double last = known, at = known * (1.0 + 1e-4), f_last = growth(last), f_at = growth(at);
  for (int i = 0; i < 6 && std::abs(at - last) > 1e-10 * at; ++i) {
    const double next = at - f_at * (at - last) / (f_at - f_last);
    last = at;
    f_last = f_at;
    at = next;
    f_at = growth(at);
  }
  return at;
}

TEST(Gradients, OfADiscThatIsNotAxisymmetricAreCentralDifferences)
{
  SquealOptions options = reference_options();
  options.friction = {.kinetic = 0.5, .rise = 0.1, .decay_speed = 2.0, .regularisation = 1e-2};
  options.pads[0].body = PadBody{.mass = 0.4, .height = 0.01, .axial = Suspension{4e6, 20.0}};
  options.study.speeds = {.from = 2.0 * pi, .to = 14.0 * pi, .count = 20};
  options.study.gradients = GradientCase{.speed = 13.0 * pi};
  int n_critical = 0;
  for (const Disc& disc : {mistuned_disc(), disc_with_vanes()}) {
    const FlexibleDisc brake(disc, options);
    ASSERT_FALSE(brake.is_autonomous());
    const auto critical = turning_critical_speed(
        brake, turning_table(brake, {.over = {}, .from = 2.0 * pi, .to = 14.0 * pi, .count = 20}));
    ASSERT_TRUE(critical);
    const double speed = turning_critical_speed_near(brake, critical->speed);
    EXPECT_NEAR(critical->speed, speed, critical->budget.sum());
    const Gradients found =
        turning_gradients(brake, options.study, CriticalSpeed{speed, critical->frequency_Hz});
    ASSERT_GE(found.motions.size(), 1u);
    EXPECT_GT(found.motions[0].growth, 0.0);
    const auto expect_row = [&](const std::string& key, double value, const auto& with) {
      const auto row = std::ranges::find(found.rows, key, &GradientRow::key);
      ASSERT_NE(row, found.rows.end()) << key;
      const auto growth_of = [&](double x) {
        const FlexibleDisc changed = with(x);
        const Hill hill(changed.disc(), changed.options(), 1e-9);
        return hill.exponents(13.0 * pi).lambda[0].real();
      };
      const Difference growth = difference(growth_of, value);
      // Of the exponents: 1e-7 1/s over a step of 1e-4 of the value.
      EXPECT_NEAR(row->growth[0], growth.value,
                  1e-4 * std::abs(growth.value) + growth.doubt + 1e-3 / value)
          << key;
      if (key != "friction.kinetic" && key != "pads[1].stiffness") return;
      const Difference by_value =
          difference([&](double x) { return turning_critical_speed_near(with(x), speed); }, value);
      EXPECT_NEAR(*row->critical_speed, by_value.value,
                  1e-4 * std::abs(by_value.value) + by_value.doubt + 1e-3 / value)
          << key;
      ++n_critical;
    };
    for (const auto& [parameter, value] : brake.parameters()) {
      if (value == 0.0) continue;
      expect_row(key_of(parameter), value, [&, parameter = parameter](double x) {
        return FlexibleDisc(disc, with_parameter(options, parameter, x));
      });
    }
    for (const Eigen::Index i : {Eigen::Index{1}, Eigen::Index{2}}) {
      const double f_Hz = disc.omega[i] / (2.0 * pi);
      expect_row(fmt::format("frequency of mode {} at {:.6g} Hz", i + 1, f_Hz), f_Hz,
                 [&](double x) {
                   Disc changed = disc;
                   changed.omega[i] = 2.0 * pi * x;
                   return FlexibleDisc(changed, options);
                 });
    }
  }
  EXPECT_GE(n_critical, 2);
}

TEST(Gradients, OfAnAxisymmetricDiscAreThoseOfItsEigenvalues)
{
  SquealOptions options = reference_options();
  options.study.speeds = {.from = 2.0 * pi, .to = 14.0 * pi, .count = 20};
  options.study.gradients = GradientCase{.speed = 6.0 * pi};
  const FlexibleDisc brake(disc_of({turned_by(kirchhoff_2(), 0.4), kirchhoff_3()}), options);
  const Gradients expected = gradients(brake, options.study);
  const Gradients found =
      turning_gradients(brake, options.study,
                        CriticalSpeed{*expected.critical_speed, *expected.critical_frequency_Hz});
  EXPECT_EQ(found.motions.size(), expected.motions.size());
  for (const GradientRow& row : expected.rows) {
    if (row.unit == "Hz") continue;  // of pairs there, of modes here
    const auto same = std::ranges::find(found.rows, row.key, &GradientRow::key);
    ASSERT_NE(same, found.rows.end()) << row.key;
    // The place of the one pad changes nothing: its derivatives are rounding.
    EXPECT_NEAR(same->growth[0], row.growth[0], 1e-6 * std::abs(row.growth[0]) + 1e-7) << row.key;
    EXPECT_NEAR(*same->critical_speed, *row.critical_speed,
                1e-6 * std::abs(*row.critical_speed) + 1e-7)
        << row.key;
  }
}

TEST(Gradients, ComeBackFromTheirFile)
{
  SquealOptions options = rich_options();
  options.study.gradients = GradientCase{.speed = 40.0};
  SquealResults results;
  results.gradients = gradients(FlexibleDisc(damped_disc(), options), options.study);
  const files::test::ScratchFolder folder;
  write_results(folder.file("a.squeal.h5"), results, {});
  const Gradients again = read_results(folder.file("a.squeal.h5")).gradients.value();
  EXPECT_EQ(again.critical_speed, results.gradients->critical_speed);
  EXPECT_EQ(again.speed, results.gradients->speed);
  ASSERT_EQ(again.rows.size(), results.gradients->rows.size());
  for (std::size_t i = 0; i < again.rows.size(); ++i) {
    EXPECT_EQ(again.rows[i].key, results.gradients->rows[i].key);
    EXPECT_EQ(again.rows[i].unit, results.gradients->rows[i].unit);
    EXPECT_EQ(again.rows[i].critical_speed, results.gradients->rows[i].critical_speed);
    EXPECT_EQ(again.rows[i].growth, results.gradients->rows[i].growth);
  }
}

}  // namespace
}  // namespace chladni::squeal
