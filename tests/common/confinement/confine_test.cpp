// What a confined process cannot do, each tried by a process of its own.
#include "common/confinement/sandbox.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/confinement/helper_process.hpp"

namespace chladni::confinement {
namespace {

constexpr Limits ample{.memory = std::uint64_t(1) << 30, .seconds = 20.0};
constexpr int did_it = 0, was_refused = 1;

/// How a process ends that does this after it was confined; the act tells whether it succeeded.
int status_after(const std::function<bool()>& act, const Limits& limits = ample)
{
  const pid_t child = fork();
  if (child == 0) {
    confine(limits);
    _exit(act() ? did_it : was_refused);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

std::optional<int> exit_code_after(const std::function<bool()>& act, const Limits& limits = ample)
{
  const int status = status_after(act, limits);
  return WIFEXITED(status) ? std::optional(WEXITSTATUS(status)) : std::nullopt;
}

/// The offence that ends a process which does this.
std::optional<Offence> offence_by(const std::function<bool()>& act)
{
  const auto code = exit_code_after(act);
  return code ? offence_of(*code) : std::nullopt;
}

std::string in_scratch(const std::string& name)
{
  return (std::filesystem::temp_directory_path() / ("chladni_confined_" + name)).string();
}

TEST(Confined, EndsWhereWhoeverStartedItHasEndedBefore)
{
  std::array<int, 2> ends{-1, -1};
  ASSERT_EQ(pipe(ends.data()), 0);
  close(ends[0]);  // nobody reads
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], answer_descriptor);
    confine(ample);
    _exit(did_it);
  }
  close(ends[1]);
  int status = -1;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), exit_left_alone);
}

TEST(Confined, ReadsComputesAndHandsOver)
{
  const auto act = [] {
    std::string word;
    std::ifstream("/proc/self/comm") >> word;
    std::vector<double> many(1000000, 1.0);
    double sum = 0.0;
    std::thread([&] {
      for (const double x : many) sum += x;
    }).join();
    return sum == 1e6 && !word.empty();
  };
  EXPECT_EQ(exit_code_after(act), did_it);
}

TEST(Confined, StartsNoProgram)
{
  std::array<char*, 2> arguments{const_cast<char*>("true"), nullptr};
  char** const words = arguments.data();
  const std::vector<std::function<bool()>> acts{
      [&] { return execv("/bin/true", words) == 0; },
      [&] { return syscall(SYS_execveat, AT_FDCWD, "/bin/true", words, environ, 0) == 0; },
#ifdef SYS_vfork
      [] { return syscall(SYS_fork) >= 0; },
#endif
      [] { return syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0) >= 0; },
  };
  for (std::size_t i = 0; i < acts.size(); ++i)
    EXPECT_EQ(offence_by(acts[i]), Offence::program) << i;
  // Where signals are held back the kernel itself ends the process: in `system`, and from
  // glibc 2.41 on in `fork`.
  const auto is_killed = [](const std::function<bool()>& act) {
    const int status = status_after(act);
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGSYS;
  };
  EXPECT_TRUE(is_killed([] { return std::system("true") == 0; }));
  const auto forks = [] { return fork() >= 0; };
  EXPECT_TRUE(offence_by(forks) == Offence::program || is_killed(forks));
  std::array<unsigned long, 11> clone3{};
  EXPECT_EQ(
      exit_code_after([&] { return syscall(SYS_clone3, clone3.data(), sizeof(clone3)) >= 0; }),
      was_refused);
}

TEST(Confined, ChangesNoFile)
{
  const std::string there = in_scratch("there"), other = in_scratch("other");
  std::ofstream(there) << "text";
  std::filesystem::remove(other);
  for (const int flags : {O_WRONLY, O_RDWR, O_RDONLY | O_CREAT, O_RDONLY | O_TRUNC,
                          O_WRONLY | O_CREAT | O_EXCL, O_RDWR | O_TMPFILE}) {
    const std::string& path = (flags & O_CREAT) != 0 ? other : there;
    EXPECT_EQ(offence_by([&] { return open(path.c_str(), flags, 0600) >= 0; }), Offence::writing)
        << flags;
  }
  const std::vector<std::function<bool()>> acts{
      [&] { return unlink(there.c_str()) == 0; },
      [&] { return rename(there.c_str(), other.c_str()) == 0; },
      [&] { return truncate(there.c_str(), 0) == 0; },
      [&] { return link(there.c_str(), other.c_str()) == 0; },
      [&] { return symlink(there.c_str(), other.c_str()) == 0; },
      [&] { return mkdir(other.c_str(), 0700) == 0; },
      [&] { return chmod(there.c_str(), 0777) == 0; },
  };
  for (std::size_t i = 0; i < acts.size(); ++i)
    EXPECT_EQ(exit_code_after(acts[i]), was_refused) << i;
  EXPECT_EQ(std::filesystem::file_size(there), 4u);
  EXPECT_FALSE(std::filesystem::exists(other));
  std::filesystem::remove(there);
}

TEST(Confined, HasNoNetwork)
{
  for (const int family : {AF_INET, AF_INET6, AF_UNIX, AF_NETLINK})
    EXPECT_EQ(offence_by([&] { return socket(family, SOCK_STREAM, 0) >= 0; }), Offence::network);
}

TEST(Confined, ReachesNoOtherProcess)
{
  const pid_t parent = getpid();
  EXPECT_EQ(exit_code_after([&] { return kill(parent, 0) == 0; }), was_refused);
  EXPECT_EQ(exit_code_after([&] { return syscall(SYS_ptrace, 16, parent, 0, 0) == 0; }),
            was_refused);
  EXPECT_EQ(exit_code_after([&] { return syscall(SYS_pidfd_open, parent, 0) >= 0; }), was_refused);
  EXPECT_EQ(exit_code_after([&] {
              rlimit limits{};
              return prlimit(parent, RLIMIT_CORE, &limits, nullptr) == 0;
            }),
            was_refused);
}

TEST(Confined, MakesNoCode)
{
  constexpr std::size_t size = 4096;
  EXPECT_EQ(exit_code_after([&] {
              return mmap(nullptr, size, PROT_READ | PROT_WRITE | PROT_EXEC,
                          MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED;
            }),
            was_refused);
}

TEST(Confined, IsOfLimitedMemory)
{
#ifdef CHLADNI_SANITIZED
  GTEST_SKIP() << "the sanitizer ends a process without memory in its own way";
#endif
  const auto swell = [] {
    std::vector<std::vector<char>> much;
    for (int i = 0; i < 1000; ++i) much.emplace_back(1 << 20, 'x');
    return much.size() == 1000;
  };
  EXPECT_EQ(exit_code_after(swell, {.memory = 100 << 20, .seconds = 20.0}), exit_out_of_memory);
  EXPECT_EQ(exit_code_after(swell, {.memory = std::uint64_t(4) << 30, .seconds = 20.0}), did_it);
}

/// What a C library does that does not look at malloc's answer.
bool fills_all(std::size_t n_blocks)
{
  constexpr std::size_t size = 1 << 20;
  for (std::size_t i = 0; i < n_blocks; ++i) {
    auto* block = static_cast<volatile char*>(std::malloc(size));
    for (std::size_t k = 0; k < size; k += 4096) block[k] = 'x';
  }
  return true;
}

TEST(Confined, CrashesForWantOfMemoryUnderThatName)
{
#ifdef CHLADNI_SANITIZED
  GTEST_SKIP() << "the sanitizer ends a process without memory in its own way";
#endif
  const Limits limits{.memory = 100 << 20, .seconds = 20.0};
  EXPECT_EQ(exit_code_after([] { return fills_all(1000); }, limits), exit_out_of_memory);
  const auto crash_early = [] {
    const volatile std::uintptr_t nowhere = 0;
    return fills_all(10) && *reinterpret_cast<volatile char*>(nowhere) == 'x';
  };
  const int status = status_after(crash_early, limits);
  ASSERT_TRUE(WIFSIGNALED(status)) << status;
  EXPECT_EQ(WTERMSIG(status), SIGSEGV);
}

TEST(Confined, IsOfLimitedTime)
{
  const auto work_on = [] {
    while (getrandom(nullptr, 0, 0) == 0) {
    }
    return true;
  };
  const int status = status_after(work_on, {.memory = std::uint64_t(1) << 30, .seconds = 0.0});
  EXPECT_TRUE(WIFSIGNALED(status)) << status;
}

}  // namespace
}  // namespace chladni::confinement
