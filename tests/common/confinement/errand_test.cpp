// Programs that are started for one answer.
#include "common/confinement/helper_process.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "common/error.hpp"

namespace chladni::confinement {
namespace {

/// A program of the shell that answers through descriptor 3, gone at the end.
class Script {
 public:
  explicit Script(const std::string& commands)
      : path_(std::filesystem::temp_directory_path() /
              ("chladni_" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name())))
  {
    std::ofstream(path_) << "#!/bin/sh\n" << commands << "\n";
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all);
  }
  ~Script() { std::filesystem::remove(path_); }
  Script(const Script&) = delete;
  Script& operator=(const Script&) = delete;

  Outcome run_with(std::string_view question, double most_seconds = 10.0) const
  {
    return run({.program = path_,
                .question = {question.begin(), question.end()},
                .most_seconds = most_seconds,
                .most_bytes = 1000});
  }

 private:
  std::filesystem::path path_;
};

std::string text(const Outcome& outcome)
{
  return {outcome.answer.begin(), outcome.answer.end()};
}

TEST(Errand, BringsTheAnswerAndTheExitCode)
{
  const Script echo("cat >&3; echo noise; echo noise >&2; exit 7");
  const Outcome outcome = echo.run_with("question");
  EXPECT_EQ(outcome.end, End::exited);
  EXPECT_EQ(outcome.code, 7);
  EXPECT_EQ(text(outcome), "question");
}

TEST(Errand, LendsNoOtherFile)
{
  const std::ifstream open_here("/proc/self/status");
  const Script list("exec 4>&3; ls /proc/self/fd | tr '\\n' ' ' >&4; exec 4>&-");
  // 3 the answer, and what `exec` and `ls` open besides: no more than without the open file.
  const std::string with_file = text(list.run_with(""));
  EXPECT_EQ(with_file, "0 1 2 3 4 5 ");
}

TEST(Errand, NamesTheSignal)
{
  const Outcome outcome = Script("kill -SEGV $$").run_with("");
  EXPECT_EQ(outcome.end, End::killed_by_signal);
  EXPECT_EQ(outcome.code, 11);
}

TEST(Errand, EndsInTime)
{
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(Script("exec sleep 60").run_with("", 0.2).end, End::took_too_long);
  EXPECT_EQ(Script("while true; do :; done").run_with("", 0.2).end, End::took_too_long);
  // One that has closed its answer and lingers is killed too.
  EXPECT_EQ(Script("exec 3>&-; exec sleep 60").run_with("", 0.2).end, End::took_too_long);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(taken.count(), 5.0);
}

TEST(Errand, SaysNoMoreThanItMay)
{
  EXPECT_EQ(Script("exec cat /dev/zero >&3").run_with("").end, End::said_too_much);
}

TEST(Errand, OfAProgramThatIsNotThereIsAnError)
{
  EXPECT_THROW(
      run({.program = "/no/such/program", .question = {}, .most_seconds = 1, .most_bytes = 1}),
      Error);
}

}  // namespace
}  // namespace chladni::confinement
