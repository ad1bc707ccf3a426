#include "common/files/output_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/common/files/scratch_folder.hpp"

namespace chladni::files {
namespace {

namespace fs = std::filesystem;

using test::bytes_of, test::error_of, test::ScratchFolder;

long n_files(const ScratchFolder& folder)
{
  return std::distance(fs::directory_iterator(folder.path()), {});
}

TEST(Replacement, ReplacesTheOldFileAndLeavesNothingElse)
{
  const ScratchFolder folder;
  write_text(folder.file("a"), "old");
  write_text(folder.file("a"), "new and longer");
  EXPECT_EQ(bytes_of(folder.file("a")), "new and longer");
  EXPECT_EQ(n_files(folder), 1);
}

TEST(Replacement, LeavesNoFileOpen)
{
  const ScratchFolder folder;
  const auto n_open = [] { return std::distance(fs::directory_iterator("/proc/self/fd"), {}); };
  const long before = n_open();
  write_text(folder.file("a"), "text");
  EXPECT_EQ(n_open(), before);
  error_of([&] { files::Replacement(folder.file("a")).write("half"); });
  EXPECT_NE(error_of([&] { write_text(folder.file("no/a"), "text"); }), "");
  EXPECT_EQ(n_open(), before);
  const int other = open(folder.file(".a.lock").c_str(), O_RDWR | O_CREAT, 0666);
  ASSERT_EQ(flock(other, LOCK_EX | LOCK_NB), 0);  // of another run
  EXPECT_NE(error_of([&] { write_text(folder.file("a"), "text"); }), "");
  EXPECT_EQ(n_open(), before + 1);
  close(other);
}

TEST(Replacement, LeavesTheOldFileWithoutACommit)
{
  const ScratchFolder folder;
  write_text(folder.file("a"), "old");
  {
    files::Replacement unfinished(folder.file("a"));
    unfinished.write("half of a n");
    EXPECT_EQ(bytes_of(unfinished.temporary()), "half of a n");
  }
  EXPECT_EQ(bytes_of(folder.file("a")), "old");
  EXPECT_EQ(n_files(folder), 1);
}

TEST(Replacement, RefusesAFolderAsItsTargetAndAFolderThatIsNotThere)
{
  const ScratchFolder folder;
  fs::create_directories(folder.path() / "taken");
  EXPECT_NE(error_of([&] { write_text(folder.file("taken"), "text"); }).find("taken: is a folder"),
            std::string::npos);
  EXPECT_NE(error_of([&] { write_text(folder.file("no/a.json"), "text"); }).find("no/a.json"),
            std::string::npos);
  EXPECT_EQ(n_files(folder), 1);
}

TEST(Replacement, HasTemporaryNamesThatNobodyCanForesee)
{
  const ScratchFolder folder;
  const files::Replacement first(folder.file("a"));
  const files::Replacement second(folder.file("a"));
  EXPECT_NE(first.temporary(), second.temporary());
}

TEST(Replacement, HasThePermissionsOfAnyNewFile)
{
  const ScratchFolder folder;
  const mode_t mask = umask(027);
  write_text(folder.file("a"), "text");
  umask(mask);
  EXPECT_EQ(fs::status(folder.file("a")).permissions(), fs::perms{0640});
}

TEST(Replacement, WritesIntoADeviceAtOnceAndTellsThatItIsFull)
{
  const ScratchFolder folder;
  fs::create_symlink("/dev/null", folder.path() / "null");
  fs::create_symlink("/dev/full", folder.path() / "full");
  write_text(folder.file("null"), "text");
  EXPECT_NE(error_of([&] { write_text(folder.file("full"), "text"); }).find("No space left"),
            std::string::npos);
  EXPECT_TRUE(fs::is_symlink(folder.path() / "null") && fs::is_symlink(folder.path() / "full"));
}

/// Of the lock file of "a", as another process would hold it.
int descriptor_of_lock(const ScratchFolder& folder)
{
  return open(folder.file(".a.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
}

TEST(OutputLock, KeepsOthersOffAsLongAsItLives)
{
  const ScratchFolder folder;
  std::shared_ptr<const OutputLock> lock = lock_output(folder.file("a"));
  const int other = descriptor_of_lock(folder);
  EXPECT_NE(flock(other, LOCK_EX | LOCK_NB), 0);
  write_text(folder.file("a"), "text");  // the process itself may
  EXPECT_NE(flock(other, LOCK_EX | LOCK_NB), 0);
  lock.reset();
  EXPECT_EQ(flock(other, LOCK_EX | LOCK_NB), 0);
  EXPECT_FALSE(fs::exists(folder.file(".a.lock")));
  close(other);
}

TEST(OutputLock, IsRefusedWhileAnotherRunWrites)
{
  const ScratchFolder folder;
  const int other = descriptor_of_lock(folder);
  ASSERT_EQ(flock(other, LOCK_EX | LOCK_NB), 0);
  EXPECT_NE(error_of([&] { write_text(folder.file("a"), "text"); }).find("another run"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder.file("a")));
  write_text(folder.file("b"), "another file");
  close(other);  // as when that run was killed: its lock file stays
  write_text(folder.file("a"), "text");
  EXPECT_EQ(n_files(folder), 2);
}

TEST(OutputLock, RemovesWhatRunsThatWereKilledHaveLeft)
{
  const ScratchFolder folder;
  for (const char* name :
       {"a.tmp-0123456789ab", "a.tmp-0123456789a", "a.tmp-of-mine-too", "b.tmp-0123456789ab"})
    std::ofstream(folder.file(name)) << "half";
  const auto lock = lock_output(folder.file("a"));
  EXPECT_FALSE(fs::exists(folder.file("a.tmp-0123456789ab")));
  EXPECT_EQ(n_files(folder), 3 + 1);
}

TEST(OutputLock, DoesNotFollowALinkInItsPlace)
{
  const ScratchFolder folder;
  fs::create_symlink(folder.path() / "victim", folder.path() / ".a.lock");
  EXPECT_NE(error_of([&] { write_text(folder.file("a"), "text"); }), "");
  EXPECT_FALSE(fs::exists(folder.file("victim")));
}

void write_half_and_raise(const std::string& path, int number)
{
  std::signal(number, SIG_DFL);  // also where the tests run under nohup
  remove_unfinished_files_on_signals();
  files::Replacement half(path);
  half.write("half");
  std::raise(number);
}

TEST(UnfinishedFile, IsRemovedByASignalThatEndsTheProcess)
{
  const ScratchFolder folder;
  write_text(folder.file("a"), "old");
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(write_half_and_raise(folder.file("a"), number), ::testing::KilledBySignal(number),
                "");
    EXPECT_EQ(n_files(folder), 1);
  }
  EXPECT_EQ(bytes_of(folder.file("a")), "old");
}

/// What a signal does now.
struct sigaction action_of(int number)
{
  struct sigaction action {};
  sigaction(number, nullptr, &action);
  return action;
}

TEST(UnfinishedFiles, AreRemovedOnSignalsButThoseThatNohupIgnores)
{
  const struct sigaction hangup = action_of(SIGHUP), interrupt = action_of(SIGINT),
                         end = action_of(SIGTERM), size = action_of(SIGXFSZ);
  std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGINT, SIG_DFL);  // also where the tests run in the background of a script
  remove_unfinished_files_on_signals();
  EXPECT_EQ(action_of(SIGHUP).sa_handler, SIG_IGN);
  EXPECT_NE(action_of(SIGTERM).sa_handler, end.sa_handler);
  EXPECT_NE(action_of(SIGINT).sa_handler, SIG_DFL);
  EXPECT_EQ(action_of(SIGXFSZ).sa_handler, SIG_IGN);
  sigaction(SIGHUP, &hangup, nullptr);
  sigaction(SIGINT, &interrupt, nullptr);
  sigaction(SIGTERM, &end, nullptr);
  sigaction(SIGXFSZ, &size, nullptr);
}

}  // namespace
}  // namespace chladni::files
