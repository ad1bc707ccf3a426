#include "report/text_table.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <new>
#include <sstream>

#include "common/error.hpp"
#include "report/json.hpp"
#include "report/page/squeal_page.hpp"
#include "report/timing.hpp"

namespace chladni::report {
namespace {

TEST(Quantities, EndWhereTheirErrorDoes)
{
  EXPECT_EQ(with_error(1.71882, 0.00213), "1.7188 +- 0.0021");
  EXPECT_EQ(with_error(-9.78935, 0.01), "-9.789 +- 0.010");
  EXPECT_EQ(with_error(8.87223, 2.6), "8.9 +- 2.6");
  EXPECT_EQ(with_error(123.456789, 1.2e-5), "123.457 +- 1.2e-05");
  EXPECT_EQ(with_error(0.0, 0.1), "0 +- 0.1");
  EXPECT_EQ(with_error(12.3456789, 0.0), "12.3457 +- 0");
}

TEST(TextTable, AlignsNumbersRightAndCountsUtf8AsItShows)
{
  const TextTable table{.header = {"mode", "f"}, .rows = {{"1", "9.5"}, {"äöü-7", "1672.13"}}};
  EXPECT_EQ(format_table(table),
            "mode         f\n"
            "1          9.5\n"
            "äöü-7  1672.13\n");
}

std::size_t longest_line(const std::string& text)
{
  std::size_t longest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

TEST(TextTable, WrapsTheWordsOfALongCell)
{
  std::string warning;
  for (int i = 0; i < 60; ++i) warning += fmt::format("{}word{}", i > 0 ? " " : "", i);
  const TextTable table{.header = {"quantity", "value", "unit"},
                        .rows = {{"transient, doubtful", warning, ""}, {"speed", "13.4", "rad/s"}}};
  const std::string text = format_table(table);
  EXPECT_LE(longest_line(text), 120U);
  std::istringstream words(text);
  const std::vector<std::string> found{std::istream_iterator<std::string>(words), {}};
  for (int i = 0; i < 60; ++i) EXPECT_EQ(std::ranges::count(found, fmt::format("word{}", i)), 1);
  const TextTable narrow{.header = {"a", "b"}, .rows = {{"1", std::string(200, 'x')}}};
  EXPECT_EQ(longest_line(format_table(narrow)), 203U) << "one word is not cut";
}

TEST(Said, IsASentenceWhereMemoryRanOut)
{
  const std::string sentence = said(std::bad_alloc());
  EXPECT_NE(sentence.find("out of memory"), std::string::npos) << sentence;
  EXPECT_EQ(said(Error("disc: \x1b")), "disc: ?");
}

squeal::UnstableInterval unstable_between(double from, double to)
{
  return {.from = {.value = from, .growth = 0.0, .frequency_Hz = 1000.0},
          .to = {.value = to, .growth = 0.0, .frequency_Hz = 1000.0},
          .worst = {.value = to, .growth = 1.0, .frequency_Hz = 1000.0}};
}

TEST(Headline, SaysWhereStabilityReturns)
{
  squeal::SquealResults results;
  results.critical_speed = {.speed = 13.4, .frequency_Hz = 1000.0};
  EXPECT_EQ(where_it_squeals(results), "squeals from 13.4 rad/s, at 1000 Hz");
  const squeal::StabilityPoint first{.value = 1.0, .growth = 1.0, .frequency_Hz = 1000.0};
  const squeal::StabilityPoint last{.value = 60.0, .growth = 1.0, .frequency_Hz = 1000.0};
  results.speed_stability = {.from = first, .to = last, .unstable = {unstable_between(13.4, 60.0)}};
  EXPECT_EQ(where_it_squeals(results), "squeals from 13.4 rad/s, at 1000 Hz");
  results.speed_stability->unstable = {unstable_between(1.0, 3.0), unstable_between(13.4, 20.0)};
  EXPECT_EQ(where_it_squeals(results),
            "squeals from 13.4 to 20 rad/s, at 1000 Hz, and in 1 other range(s) of speeds");
}

TEST(TextTable, CommandsNoTerminal)
{
  const TextTable table{.header = {"set"}, .rows = {{"\x1b]0;owned\a\x9b"}, {"\xc2\x9b\x7f ä"}}};
  EXPECT_EQ(format_table(table), "set\n?]0;owned?\x9b\n?? ä\n");
  EXPECT_EQ(printable("two\nlines\r\x1b[2J"), "two\nlines??[2J");
}

TEST(Json, EscapesTexts)
{
  EXPECT_EQ(Json("a\"b\\c\n\t\r\x01 ü").text(), "\"a\\\"b\\\\c\\n\\t\\r\\u0001 ü\"");
}

TEST(Json, HasNoNumberThatIsNotFinite)
{
  EXPECT_EQ(Json(std::numeric_limits<double>::quiet_NaN()).text(), "null");
  EXPECT_EQ(Json(-std::numeric_limits<double>::infinity()).text(), "null");
}

TEST(Json, KeepsEveryDigitOfADouble)
{
  const double x = 1672.1300000000001;
  EXPECT_EQ(std::stod(Json(x).text()), x);
  EXPECT_EQ(Json(0.1).text(), "0.1");
}

TEST(Json, NestsObjectsAndArrays)
{
  const Json json =
      Json::object({{"n", 3}, {"x", Json::array({1.5, Json(), "t"})}, {"e", Json::array({})}});
  EXPECT_EQ(json.text(), R"({"n": 3, "x": [1.5, null, "t"], "e": []})");
}

TEST(Stopwatch, CountsTheWorkOfThisProcess)
{
  const Stopwatch watch;
  double sum = 0.0;
  while (watch.wall_s() < 0.05) sum += std::sqrt(sum + 1.0);
  EXPECT_GT(sum, 0.0);
  EXPECT_GT(watch.cpu_s(), 0.0);
  // One thread works, so it has no more CPU time than wall time, but for the clock's granularity.
  EXPECT_LT(watch.cpu_s(), watch.wall_s() + 0.02);
  EXPECT_GT(peak_MiB(), 1.0);
}

/// Of a study that used the modes with these numbers.
squeal::SquealResults limit_cycle_of(std::vector<int> mode_numbers, Eigen::Index n_amplitudes)
{
  squeal::LimitCycle cycle{};
  cycle.mode_numbers = std::move(mode_numbers);
  cycle.amplitude = Eigen::VectorXcd::Ones(n_amplitudes);
  squeal::SquealResults results;
  results.limit_cycle = cycle;
  return results;
}

TEST(SquealMotions, ArePutAmongTheModesOfTheBody)
{
  const auto motions = squeal_motions(limit_cycle_of({1, 3}, 2), {1, 3}, 4);
  ASSERT_EQ(motions.size(), 1u);
  EXPECT_EQ(motions[0].amplitude, Eigen::Vector4cd(1.0, 0.0, 1.0, 0.0));
}

TEST(SquealMotions, BeginWithWhatIsALimitCycle)
{
  squeal::SquealResults results = limit_cycle_of({1, 3}, 2);
  results.limit_cycle->settled = false;
  results.limit_cycle_direct = squeal::DirectLimitCycle{};
  results.limit_cycle_direct->multipliers = Eigen::VectorXcd::Constant(2, 0.5);
  results.limit_cycle_direct->mode_numbers = {1, 3};
  results.limit_cycle_direct->amplitude = Eigen::VectorXcd::Constant(2, 2.0);
  const auto motions = squeal_motions(results, {1, 3}, 4);
  ASSERT_EQ(motions.size(), 2u);
  EXPECT_EQ(motions[0].amplitude[0], 2.0) << motions[0].name;
  EXPECT_EQ(motions[1].name, "End of the transient at 0 rad/s, not settled");
}

TEST(SquealMotions, OfAnotherBodyAreRefused)
{
  EXPECT_THROW(squeal_motions(limit_cycle_of({1, 19}, 2), {1, 19}, 3), Error);  // 19 of 3 modes
  EXPECT_THROW(squeal_motions(limit_cycle_of({0, 1}, 2), {0, 1}, 3), Error);
  EXPECT_THROW(squeal_motions(limit_cycle_of({1, 2}, 3), {1, 2}, 3), Error);  // one too many
}

}  // namespace
}  // namespace chladni::report
