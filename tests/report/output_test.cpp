#include "report/output.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "common/error.hpp"
#include "report/json.hpp"
#include "report/page/squeal_results.hpp"
#include "report/timing.hpp"

namespace chladni::report {
namespace {

std::string content(const std::filesystem::path& path)
{
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// A folder of the test's own, removed at its end.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("chladni_output_test_" + std::to_string(::getpid())))
  {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

TEST(TextTable, AlignsNumbersRightAndCountsUtf8AsItShows)
{
  const TextTable table{.header = {"mode", "f"}, .rows = {{"1", "9.5"}, {"äöü-7", "1672.13"}}};
  EXPECT_EQ(format_table(table),
            "mode         f\n"
            "1          9.5\n"
            "äöü-7  1672.13\n");
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

TEST(WriteTextAtomically, ReplacesTheOldTextAndLeavesNothingElse)
{
  const Folder folder;
  const auto path = folder.path() / "summary.json";
  write_text_atomically(path, "old");
  write_text_atomically(path, "new and longer");
  EXPECT_EQ(content(path), "new and longer");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteTextAtomically, LeavesNoFileWhenItCannotRename)
{
  const Folder folder;
  const auto path = folder.path() / "taken";
  std::filesystem::create_directories(path / "inside");  // a folder cannot be replaced by a file
  EXPECT_THROW(write_text_atomically(path, "text"), Error);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteTextAtomically, NamesAFolderThatDoesNotExist)
{
  try {
    write_text_atomically("/nowhere/summary.json", "text");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/summary.json"), std::string::npos);
  }
}

TEST(ProgressText, IsSilentForTwoSecondsAndThenTellsTheTimeLeft)
{
  EXPECT_FALSE(progress_text("transient", 0.5, 1.9));
  EXPECT_EQ(progress_text("transient", 0.25, 4.0), "transient: 25 %, 12 s left");
  EXPECT_EQ(progress_text("transient", 0.0, 4.0), "transient: 4 s");
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

TEST(SquealMotions, OfAnotherBodyAreRefused)
{
  EXPECT_THROW(squeal_motions(limit_cycle_of({1, 19}, 2), {1, 19}, 3), Error);  // 19 of 3 modes
  EXPECT_THROW(squeal_motions(limit_cycle_of({0, 1}, 2), {0, 1}, 3), Error);
  EXPECT_THROW(squeal_motions(limit_cycle_of({1, 2}, 3), {1, 2}, 3), Error);  // one too many
}

}  // namespace
}  // namespace chladni::report
