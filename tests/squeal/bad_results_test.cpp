// Result files that no run wrote: what the programs index with later is refused where it is read,
// by the name of the dataset.
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "common/files/hdf5.hpp"
#include "squeal/results/squeal_results.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "version_1_results.hpp"

namespace chladni::squeal {
namespace {

using files::test::ScratchFolder, files::test::error_of;

/// What reading says after `damage` was done to the results before they were written.
std::string error_after(const std::function<void(SquealResults&)>& damage)
{
  const ScratchFolder folder;
  SquealResults results = test::version_1_results();
  damage(results);
  write_results(folder.file("bad.squeal.h5"), results, {});
  return error_of([&] { read_results(folder.file("bad.squeal.h5")); });
}

void expect_refusal(const std::string& name, const std::function<void(SquealResults&)>& damage)
{
  const std::string error = error_after(damage);
  EXPECT_NE(error.find("bad.squeal.h5: " + name + ": "), std::string::npos)
      << "'" << error << "' lacks '" << name << "'";
}

TEST(BadResults, AreOthersThanTheGoldenOnes)
{
  EXPECT_EQ(error_after([](SquealResults&) {}), "");
}

TEST(BadResults, LackValuesOfWhichTheLargestIsAsked)
{
  expect_refusal("stability_map/values", [](SquealResults& r) {
    r.map->values.resize(0);
    r.map->growth.resize(0, 3);
    r.map->frequency_Hz.resize(0, 3);
  });
  expect_refusal("stability_map/speeds", [](SquealResults& r) {
    r.map->speeds.resize(0);
    r.map->growth.resize(2, 0);
    r.map->frequency_Hz.resize(2, 0);
  });
  expect_refusal("rotation_stability/speeds", [](SquealResults& r) {
    r.rotation_stability = RotationStability{{}, {}, {}, {}};
  });
  expect_refusal("spectrum/frequency", [](SquealResults& r) { r.spectrum = Spectrum{}; });
  expect_refusal("limit_cycle_direct/x", [](SquealResults& r) {
    r.limit_cycle_direct->x.resize(1);
    r.limit_cycle_direct->multipliers.resize(1);
  });
}

TEST(BadResults, NameModesThatCannotBe)
{
  expect_refusal("limit_cycle/mode_numbers", [](SquealResults& r) {
    r.limit_cycle->mode_numbers = {0, 1};
  });
  expect_refusal("limit_cycle/mode_numbers", [](SquealResults& r) {
    r.limit_cycle->mode_numbers = {3, 3};
  });
  expect_refusal("limit_cycle_direct/mode_numbers", [](SquealResults& r) {
    r.limit_cycle_direct->mode_numbers = {-1, 1};
  });
  expect_refusal("eigenvalues/mode_numbers", [](SquealResults& r) {
    r.eigenvalues->mode_numbers = {-2, 1};
  });
  expect_refusal("eigenvalues/shapes/1/re", [](SquealResults& r) {
    r.eigenvalues->mode_numbers = {1, 2, 3, 4};
  });
}

TEST(BadResults, CountBelowZero)
{
  expect_refusal("critical/newton_steps",
                 [](SquealResults& r) { r.critical_speed->n_newton_steps = -1; });
  expect_refusal("critical_values/1/newton_steps",
                 [](SquealResults& r) { r.critical_values[0].n_newton_steps = -1; });
  expect_refusal("limit_cycle_direct/newton_steps",
                 [](SquealResults& r) { r.limit_cycle_direct->n_newton_steps = -1; });
  expect_refusal("mode_sensitivity/subsets/1/n_modes",
                 [](SquealResults& r) { r.mode_sensitivity->subsets[0].n_modes = -1; });
  expect_refusal("mode_sensitivity/modes/1/nodal_diameters",
                 [](SquealResults& r) { r.mode_sensitivity->influences[0].nodal_diameters = -1; });
  expect_refusal("transient/events/pad", [](SquealResults& r) { r.transient->events[0].pad = -1; });
}

TEST(BadResults, HaveHistoriesThatDoNotFitTogether)
{
  expect_refusal("transient/windows/open", [](SquealResults& r) {
    r.transient->windows = {{0.0}, {1.0}, {1.0}, {1.0}, {1.0}, {1.0}, {1.0}, {0.0, 0.0}};
  });
  expect_refusal("transient/tail/t", [](SquealResults& r) { r.transient->tail.t[0] = 7.0; });
  expect_refusal("transient/envelope/t",
                 [](SquealResults& r) { r.transient->envelope.t[0] = 7.0; });
}

TEST(BadRadiation, NamesModesThatCannotBe)
{
  const ScratchFolder folder;
  const std::string path = folder.file("bad.radiation.h5");
  Radiation radiation = test::version_1_radiation();
  radiation.mode_numbers = {1, 1};
  write_radiation(path, radiation, "", {});
  EXPECT_NE(error_of([&] { read_radiation(path); }).find("mode_numbers: names mode 1 twice"),
            std::string::npos);
  files::Writer writer(path);  // numbers that are 1 and 3 again where an int has 32 bits
  writer.attribute("/", "format", "chladni-radiation");
  writer.attribute("/", "version", 1);
  writer.write("mode_numbers",
               std::span<const std::int64_t>(std::vector<std::int64_t>{(1LL << 32) + 1, 3}), "1");
  writer.commit();
  EXPECT_NE(error_of([&] { read_radiation(path); }).find("mode_numbers: has the index 4294967297"),
            std::string::npos);
}

constexpr auto version_1_file = CHLADNI_SOURCE_DIR "/tests/data/version_1.squeal.h5";

/// No dataset has left the lists of fields except those that no program reads.
TEST(Version1, OfResultsIsWrittenAgain)
{
  const ScratchFolder folder;
  const files::Reader first(version_1_file);
  write_results(folder.file("again.squeal.h5"), read_results(first), {});
  const files::Reader again(folder.file("again.squeal.h5"));
  const std::set<std::string> left{"transient/history/energy", "transient/history/q",
                                   "transient/history/q_dot"};
  for (const files::Item& item : files::contents(first)) {
    if (left.contains(item.name) || item.name.starts_with("provenance")) continue;
    ASSERT_TRUE(again.contains(item.name)) << item.name;
    if (!item.unit.empty()) {
      EXPECT_EQ(again.text_attribute(item.name, "unit"), item.unit);
    }
  }
}

TEST(Version1, OfResultsIsReadBitByBit)
{
  const SquealResults a = test::version_1_results();
  const SquealResults b = read_results(std::filesystem::path(version_1_file));
  EXPECT_EQ(b.eigenvalues->lambda, a.eigenvalues->lambda);
  EXPECT_EQ(b.eigenvalues->shapes, a.eigenvalues->shapes);
  EXPECT_EQ(b.eigenvalues->mode_numbers, a.eigenvalues->mode_numbers);
  test::expect_equal(b.map, a.map);
  test::expect_equal(b.rotation_stability, a.rotation_stability);
  EXPECT_EQ(b.critical_values[0].value, a.critical_values[0].value);
  test::expect_equal(b.critical_speed, a.critical_speed);
  EXPECT_EQ(files::difference(b.speed_stability->unstable, a.speed_stability->unstable), "");
  test::expect_equal(b.mode_sensitivity, a.mode_sensitivity);
  EXPECT_EQ(files::difference(b.growth, a.growth), "");
  test::expect_equal(b.transient, a.transient);
  test::expect_equal(b.limit_cycle, a.limit_cycle);
  test::expect_equal(b.limit_cycle_direct, a.limit_cycle_direct);
  EXPECT_EQ(stability_of(*b.limit_cycle_direct), CycleStability::stable);
  test::expect_equal(b.limit_cycle_branch, a.limit_cycle_branch);
  test::expect_equal(b.spectrum, a.spectrum);
  EXPECT_EQ(b.failure, a.failure);
  const auto radiation = read_radiation(CHLADNI_SOURCE_DIR "/tests/data/version_1.radiation.h5");
  EXPECT_EQ(radiation.mode_numbers, test::version_1_radiation().mode_numbers);
  EXPECT_EQ(radiation.damping, test::version_1_radiation().damping);
}

}  // namespace
}  // namespace chladni::squeal
