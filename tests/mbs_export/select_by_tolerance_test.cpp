#include "mbs_export/select_by_tolerance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <numbers>
#include <string>

#include "bending_beam.hpp"
#include "common/eigen_every.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mbs_export/make_body.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double omega_1_of_beam = 22.3732854528785649;  // rad/s, free beam of 300 elements
constexpr double hertz = 2.0 * std::numbers::pi;         // rad/s

/// Rows of `attachment_modes`.
constexpr int rotation_of_B = 6 + 4;

InterfaceModes interface_modes(InterfaceModes::Kind kind, std::optional<double> omega0)
{
  return {.kind = kind, .at = "B", .components = {4}, .omega0 = omega0};
}

/// The clamped beam under a moment at B, up to three times the first free frequency.
BodyOptions moment_at_B(double error)
{
  BodyOptions options;
  options.fixed = {"A"};
  options.interface_modes = {interface_modes(InterfaceModes::Kind::frm, {})};
  options.keep.tolerance = Tolerance{.error = error, .up_to_Hz = 3.0 * omega_1_of_beam / hertz};
  return options;
}

constexpr double rim_range_Hz = 2000.0;

/// The wheel held at its hub, loaded normal to its plane all around the rim. Five modes in the
/// range answer to that; a sixth one, at 1515 Hz, turns about the axis.
BodyOptions loaded_rim(double error)
{
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.tolerance = Tolerance{.error = error, .up_to_Hz = rim_range_Hz};
  return options;
}

/// Receptances between rows of `attachment_modes`, with the damping of the comparison.
MatrixXcd receptances(const ModalBody& body, const std::vector<int>& rows, double Omega)
{
  const Eigen::VectorXcd d =
      std::complex<double>(1.0, 0.02) * body.omega.array().square() - Omega * Omega;
  const MatrixXd B = body.attachment_modes(rows, every);
  return B * d.cwiseInverse().asDiagonal() * B.transpose();
}

/// Largest error of the response to one load over the range, at frequencies of its own; relative to
/// the response, or to the root sum of squares of its modal parts where these cancel.
double largest_error(const ModalBody& body, const ModalBody& complete, const std::vector<int>& rows,
                     double Omega_max)
{
  constexpr int n_frequencies = 3000;
  const MatrixXd B = complete.attachment_modes(rows, every);
  double largest = 0.0;
  for (int i = 0; i <= n_frequencies; ++i) {
    const double Omega = Omega_max * i / n_frequencies;
    const MatrixXcd H = receptances(complete, rows, Omega);
    const MatrixXcd difference = receptances(body, rows, Omega) - H;
    for (Index j = 0; j < H.cols(); ++j) {
      double squares = 0.0;
      for (Index k = 0; k < B.cols(); ++k) {
        squares +=
            B.col(k).squaredNorm() * B(j, k) * B(j, k) /
            std::norm(std::complex<double>(1.0, 0.02) * complete.omega[k] * complete.omega[k] -
                      Omega * Omega);
      }
      largest = std::max(largest,
                         difference.col(j).norm() / std::max(H.col(j).norm(), std::sqrt(squares)));
    }
  }
  return largest;
}

ModalBody unselected_body(const ReducedSystem& reduced, const BodyOptions& options)
{
  BodyOptions all = options;
  all.keep = {};
  all.interface_modes = {};
  return make_body(reduced, all);
}

std::vector<int> rim_z()
{
  std::vector<int> rows;
  for (int node = 0; node < test::wheel_rim_nodes; ++node) rows.push_back(6 * node + 2);
  return rows;
}

TEST(SelectByTolerance, MeetsItBetweenTheFrequenciesThatWereCompared)
{
  const ReducedSystem& beam = test::regression_beam();
  const ReducedSystem wheel = test::wheel();
  for (const double error : {1e-1, 1e-3, 1e-5}) {
    const BodyOptions moment = moment_at_B(error), rim = loaded_rim(error);
    // Between grid points the error may exceed that on the grid a little: its peaks are as wide as
    // the resonances, which the grid resolves by three points.
    EXPECT_LT(largest_error(make_body(beam, moment), unselected_body(beam, moment), {rotation_of_B},
                            3.0 * omega_1_of_beam),
              1.2 * error);
    EXPECT_LT(largest_error(make_body(wheel, rim), unselected_body(wheel, rim), rim_z(),
                            rim_range_Hz * hertz),
              1.2 * error);
  }
}

TEST(SelectByTolerance, FindsNoMoreThanFiveModesAndOneFrequencyResponseModeOnTheBeam)
{
  // The basis of the thesis, and its accuracy by the same measure.
  const ReducedSystem& beam = test::regression_beam();
  BodyOptions options = moment_at_B(0.5);
  const ModalBody complete = unselected_body(beam, options);
  options.keep = {.count = 5, .up_to_Hz = {}, .list = {}};
  const ModalBody by_hand = make_body(beam, options);
  ASSERT_EQ(by_hand.n_modes(), 6);
  const double error = largest_error(by_hand, complete, {rotation_of_B}, 3.0 * omega_1_of_beam);
  EXPECT_LT(error, 1e-2);
  const ModalBody chosen = make_body(beam, moment_at_B(error));
  EXPECT_LE(chosen.n_modes(), 6);
  // As above between the grid points.
  EXPECT_LT(largest_error(chosen, complete, {rotation_of_B}, 3.0 * omega_1_of_beam), 1.2 * error);
  // Modes alone are far from it: a moment's response converges slowly in modes.
  EXPECT_GT(chosen.selection->modes_only.back().size(), 30);
}

TEST(SelectByTolerance, ReportsWhatEachSizeBuys)
{
  const ModalBody body = make_body(test::regression_beam(), moment_at_B(1e-3));
  ASSERT_TRUE(body.selection);
  const SelectionTable& table = *body.selection;
  EXPECT_EQ(table.loads, std::vector<std::string>{"B.ry"});
  for (const auto* steps : {&table.modes_only, &table.with_interface_modes}) {
    // 3.5, 22.0 and 61.7 rad/s lie in the range, 120.9 rad/s does not.
    ASSERT_GT(steps->size(), 3u);
    for (std::size_t i = 0; i < steps->size(); ++i)
      EXPECT_EQ((*steps)[i].size(), static_cast<int>(i) + 1);
    EXPECT_EQ((*steps)[2].added, "mode 3");
    EXPECT_EQ((*steps)[2].n_interface, 0);
    EXPECT_GT((*steps)[steps->size() - 2].error, 1e-3);
    EXPECT_LE(steps->back().error, 1e-3);
  }
  EXPECT_EQ(body.n_modes(), table.with_interface_modes.back().size());
  EXPECT_EQ(std::ranges::count(body.kinds, ModeKind::interface),
            table.with_interface_modes.back().n_interface);
}

TEST(SelectByTolerance, ReportsTheErrorOfTheBodyThatIsMade)
{
  // The error is updated step by step and the body made anew from the choice: equal to round-off,
  // except that the finer frequencies of the check may find a little more.
  const ReducedSystem wheel = test::wheel();
  const BodyOptions options = loaded_rim(1e-4);
  const ModalBody body = make_body(wheel, options);
  const double error =
      largest_error(body, unselected_body(wheel, options), rim_z(), rim_range_Hz * hertz);
  EXPECT_NEAR(error / body.selection->with_interface_modes.back().error, 1.0, 0.2);
}

TEST(SelectByTolerance, KeepsResonancesThatAreExcitedAndNoOthers)
{
  const ReducedSystem wheel = test::wheel();
  const ModalBody complete = unselected_body(wheel, loaded_rim(1e-2));
  const ModalBody body = make_body(wheel, loaded_rim(1e-2));
  int n_excited = 0, n_silent = 0;
  for (Index k = 0; k < complete.n_modes() && complete.omega[k] < rim_range_Hz * hertz; ++k) {
    const auto share = complete.attachment_modes(rim_z(), k).squaredNorm() /
                       complete.attachment_modes.col(k).squaredNorm();
    const bool is_kept =
        ((body.omega.array() - complete.omega[k]).abs() < 1e-9 * complete.omega[k]).any();
    EXPECT_TRUE(share <= 1e-4 || is_kept) << k;
    EXPECT_TRUE(share >= 1e-12 || !is_kept) << k;
    n_excited += share > 1e-4 ? 1 : 0;
    n_silent += share < 1e-12 ? 1 : 0;
  }
  EXPECT_EQ(n_excited, 5);
  EXPECT_EQ(n_silent, 1);
}

TEST(SelectByTolerance, KeepsTheSymmetryOfARing)
{
  const ReducedSystem wheel = test::wheel();
  const ModalBody body = make_body(wheel, loaded_rim(1e-3));
  ASSERT_GT(std::ranges::count(body.kinds, ModeKind::interface), 0);
  ASSERT_LT(std::ranges::count(body.kinds, ModeKind::interface), 12);  // not simply all of them
  const MatrixXcd H = receptances(body, rim_z(), 1234.0 * hertz);
  for (Index i = 0; i < H.rows(); ++i)
    for (Index j = 0; j < H.cols(); ++j)
      EXPECT_NEAR(std::abs(H(i, j) - H((i + 1) % H.rows(), (j + 1) % H.cols())), 0.0,
                  1e-9 * H.cwiseAbs().maxCoeff());  // round-off
}

TEST(SelectByTolerance, TakesTheFrequencyGivenByHand)
{
  BodyOptions options = moment_at_B(1e-2);
  options.interface_modes = {interface_modes(InterfaceModes::Kind::frm, 11.0 * hertz)};
  const auto has = [](const ModalBody& body, const std::string& word) {
    return std::ranges::count_if(body.selection->with_interface_modes, [&](const auto& step) {
      return step.added.find(word) != std::string::npos;
    });
  };
  const ModalBody by_hand = make_body(test::regression_beam(), options);
  EXPECT_EQ(has(by_hand, "B.ry, 11 Hz"), 1);
  EXPECT_EQ(has(by_hand, "B.ry"), 1);
  options.interface_modes = {interface_modes(InterfaceModes::Kind::irm, {})};
  const ModalBody inertia_relief = make_body(test::regression_beam(), options);
  EXPECT_EQ(has(inertia_relief, "B.ry, static"), 1);
  EXPECT_EQ(has(inertia_relief, "B.ry"), 1);
}

TEST(SelectByTolerance, TakesNoInterfaceModeAtTheResonanceOfAModeThatIsNeglected)
{
  // The response of a neglected mode at its own frequency has no limit. The fourth mode lies beyond
  // the range, and no resonance asks for it.
  BodyOptions options = moment_at_B(1e-3);
  const double omega_4 = unselected_body(test::regression_beam(), options).omega[3];
  ASSERT_GT(omega_4, 1.5 * 3.0 * omega_1_of_beam);
  for (const double beside : {0.0, -5e-7, 5e-7}) {  // within 1e-6 it is the same frequency
    options.interface_modes = {
        interface_modes(InterfaceModes::Kind::frm, omega_4 * (1.0 + beside))};
    const ModalBody body = make_body(test::regression_beam(), options);
    bool has_mode_4 = false;
    for (const SelectionStep& step : body.selection->with_interface_modes) {
      has_mode_4 = has_mode_4 || step.added == "mode 4";
      EXPECT_TRUE(has_mode_4 || step.n_interface == 0) << step.added << ", " << beside;
    }
    EXPECT_LE(body.selection->with_interface_modes.back().error, 1e-3);
  }
}

TEST(SelectByTolerance, TakesNaturalModesWhereBothWaysNeedAsMany)
{
  const ModalBody body = make_body(test::wheel(), loaded_rim(0.1));
  const SelectionStep& natural = body.selection->modes_only.back();
  const SelectionStep& mixed = body.selection->with_interface_modes.back();
  ASSERT_LE(std::max(natural.error, mixed.error), 0.1);
  ASSERT_EQ(natural.size(), mixed.size());
  ASSERT_GT(mixed.n_interface, 0);
  EXPECT_EQ(std::ranges::count(body.kinds, ModeKind::interface), 0);
  EXPECT_EQ(body.n_modes(), natural.size());
}

TEST(SelectByTolerance, KeepsTheRigidMotionsOfAFreeBody)
{
  BodyOptions options;
  options.interface_modes = {
      {.kind = InterfaceModes::Kind::frm, .at = "B", .components = {2, 4}, .omega0 = {}}};
  options.keep.tolerance = Tolerance{.error = 1e-3, .up_to_Hz = 3.0 * omega_1_of_beam / hertz};
  const ModalBody body = make_body(test::regression_beam(), options);
  EXPECT_EQ(std::ranges::count(body.kinds, ModeKind::rigid), 2);
  EXPECT_EQ(body.selection->with_interface_modes.front().added, "modes 1, 2");
  EXPECT_LE(body.selection->with_interface_modes.back().error, 1e-3);
  EXPECT_LT(body.n_modes(), 12);
}

TEST(SelectByTolerance, SaysHowFarItGotWithAToleranceBelowRoundOff)
{
  const ModalBody body = make_body(test::wheel(), loaded_rim(1e-17));
  const auto& table = *body.selection;
  const double best =
      std::min(table.modes_only.back().error, table.with_interface_modes.back().error);
  EXPECT_GT(best, 1e-17);
  EXPECT_LT(best, 1e-11);  // round-off of 72 modes
  const SelectionStep& closer =
      table.modes_only.back().error <= table.with_interface_modes.back().error
          ? table.modes_only.back()
          : table.with_interface_modes.back();
  EXPECT_EQ(body.n_modes(), closer.size());
}

TEST(SelectByTolerance, IsKeptInTheBodyFile)
{
  const files::test::ScratchFolder folder;
  const ModalBody a = make_body(test::wheel(), loaded_rim(1e-2));
  write_body(folder.file("a.h5"), a);
  const ModalBody b = read_body(folder.file("a.h5"));
  ASSERT_TRUE(b.selection);
  EXPECT_EQ(a.selection->error, b.selection->error);
  EXPECT_EQ(a.selection->Omega_max, b.selection->Omega_max);
  EXPECT_EQ(a.selection->loads, b.selection->loads);
  ASSERT_EQ(a.selection->modes_only.size(), b.selection->modes_only.size());
  const SelectionStep &x = a.selection->with_interface_modes.back(),
                      &y = b.selection->with_interface_modes.back();
  EXPECT_EQ(x.added, y.added);
  EXPECT_EQ(x.n_modes, y.n_modes);
  EXPECT_EQ(x.n_interface, y.n_interface);
  EXPECT_EQ(x.error, y.error);
}

TEST(SelectByTolerance, RefusesASecondCriterion)
{
  BodyOptions options = loaded_rim(1e-2);
  options.keep.count = 10;
  EXPECT_NE(files::test::error_of([&] { make_body(test::wheel(), options); }).find("nothing else"),
            std::string::npos);
}

}  // namespace
}  // namespace chladni::mbs_export
