#include "mbs_export/held_modes.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "bending_beam.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

ConstrainedModes modes_of(const ReducedSystem& reduced, const std::vector<std::string>& fixed)
{
  return constrained_modes(shift_modes(orthogonalize(reduced), held_dofs(reduced, fixed)));
}

/// Full 300-element frequency (60-digit arithmetic) and the relative error of the reduction to 100
/// fixed-interface modes.
struct ExactMode {
  int number;  ///< 1-based
  double omega_full;
  double reduction_error;
};

void expect_modes(const ConstrainedModes& modes, const std::vector<ExactMode>& exact)
{
  for (const auto& [number, omega_full, error] : exact)
    // Round-off of K_r: 1e-6 of lambda, i.e. 1e-7 of the first omega^2, and less further up.
    EXPECT_NEAR(modes.omega[number - 1] / (omega_full * (1.0 + error)), 1.0, 2e-8) << number;
}

TEST(ConstrainedModes, OfTheClampedBeamHaveTheKnownReductionErrors)
{
  const ConstrainedModes modes = modes_of(test::regression_beam(), {"A"});
  ASSERT_EQ(modes.omega.size(), 104);
  EXPECT_EQ(modes.n_rigid, 0);
  expect_modes(modes, {{1, 3.51601526850387769813, 1.9114278572001824e-12},
                       {2, 22.0344915655839460002, 1.2427009039669273e-10},
                       {3, 61.6972144336831586357, 1.1084010579085737e-09},
                       {10, 890.731857765138858840, 1.1035972161683017e-07},
                       {80, 62398.7578230727804930, 6.64457123997812e-4},
                       {100, 97789.0537209416643136, 3.024789381626362e-3}});
}

TEST(ConstrainedModes, OfTheSupportedBeamHaveTheKnownReductionErrors)
{
  const ConstrainedModes modes = modes_of(test::regression_beam(), {"A.z", "C.z"});
  ASSERT_EQ(modes.omega.size(), 104);
  expect_modes(modes, {{1, 9.86960440117178198829, 1.0894696336619025e-11},
                       {2, 39.4784176096324805373, 1.7444088827087326e-10},
                       {3, 88.8264396698893578367, 1.4246407013254902e-12},
                       {50, 24675.2888636516505424, 8.835004290502264e-05},
                       {100, 98775.9607686643448591, 7.571592489815796e-03}});
}

TEST(ConstrainedModes, OfAFullyHeldInterfaceAreTheFixedInterfaceModes)
{
  const ReducedSystem& beam = test::regression_beam();
  const ConstrainedModes modes = modes_of(beam, {"A", "B", "C"});
  ASSERT_EQ(modes.omega.size(), 100);
  for (int i = 0; i < 80; ++i)
    EXPECT_NEAR(modes.omega[i] / beam.fixed_interface_frequencies[i], 1.0, 1e-7);
}

TEST(ConstrainedModes, KeepExactZerosForWhatNothingHolds)
{
  const ConstrainedModes modes = modes_of(test::wheel(), {"rim.z"});
  EXPECT_EQ(modes.n_rigid, 3);
  EXPECT_EQ(modes.omega[2], 0.0);
  EXPECT_GT(modes.omega[3], 100.0);
}

TEST(SelectModes, NeverPartsTheTwoModesOfAPair)
{
  const Eigen::VectorXd omega{{1.0, 2.0, 2.0 + 1e-5, 3.0}};
  const ModeSelection counted = select_modes(omega, {.count = 2, .up_to_Hz = {}, .list = {}});
  EXPECT_EQ(counted.kept, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(counted.neglected, (std::vector<int>{3}));
  EXPECT_EQ(counted.n_partners, 1);
  const double between = (2.0 + 5e-6) / (2.0 * std::numbers::pi);
  EXPECT_EQ(select_modes(omega, {.count = {}, .up_to_Hz = between, .list = {}}).kept.size(), 3u);
  const ModeSelection listed =
      select_modes(omega, {.count = {}, .up_to_Hz = {}, .list = std::vector{3, 4}});
  EXPECT_EQ(listed.kept, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(listed.n_partners, 1);
  EXPECT_EQ(select_modes(omega, {}).kept.size(), 4u);
}

TEST(SelectModes, RefusesWhatDoesNotExist)
{
  const Eigen::VectorXd omega{{1.0, 2.0}};
  EXPECT_NE(
      files::test::error_of([&] { select_modes(omega, {.count = 3, .up_to_Hz = {}, .list = {}}); }),
      "");
  EXPECT_NE(files::test::error_of([&] {
              select_modes(omega, {.count = {}, .up_to_Hz = {}, .list = std::vector{0}});
            }),
            "");
  EXPECT_NE(files::test::error_of([&] {
              select_modes(omega, {.count = {}, .up_to_Hz = 0.01, .list = {}});
            }).find("no mode is left"),
            std::string::npos);
  EXPECT_NE(files::test::error_of(
                [&] { select_modes(omega, {.count = 1, .up_to_Hz = 1.0, .list = {}}); }),
            "");
}

}  // namespace
}  // namespace chladni::mbs_export
