#include "confinement/errand.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <string>
#include <thread>

#include "common/error.hpp"

namespace chladni::confinement {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const char* what, int error)
{
  throw Error(fmt::format("{}: {}", what, std::strerror(error)));
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return number_; }
  void reset()
  {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

void write_all(int descriptor, const std::vector<char>& bytes)
{
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno != EINTR) fail("cannot hand over a question", errno);
    done += std::max<ssize_t>(n, 0);
  }
  ::lseek(descriptor, 0, SEEK_SET);
}

/// What becomes of the descriptors of a program, and of its signals.
class Surroundings {
 public:
  Surroundings(int question, int answer)
  {
    posix_spawn_file_actions_init(&files_);
    // The answer's own number may be one that is written over.
    posix_spawn_file_actions_adddup2(&files_, question, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files_, answer, answer_descriptor);
    for (const int output : {STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&files_, output, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&files_, answer_descriptor + 1);
    posix_spawnattr_init(&signals_);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&signals_, &none);
    posix_spawnattr_setsigdefault(&signals_, &all);
    posix_spawnattr_setflags(&signals_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~Surroundings()
  {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&signals_);
  }
  Surroundings(const Surroundings&) = delete;
  Surroundings& operator=(const Surroundings&) = delete;

  pid_t start(const std::string& program) const
  {
    std::string name = program;
    std::array<char*, 2> arguments{name.data(), nullptr};
    pid_t child = -1;
    const int error =
        posix_spawn(&child, program.c_str(), &files_, &signals_, arguments.data(), environ);
    if (error != 0) fail(program.c_str(), error);
    return child;
  }

 private:
  posix_spawn_file_actions_t files_{};
  posix_spawnattr_t signals_{};
};

/// A descriptor above those that a program on an errand gets.
int above_the_given(int descriptor)
{
  const int moved = ::fcntl(descriptor, F_DUPFD_CLOEXEC, answer_descriptor + 1);
  const int error = errno;
  ::close(descriptor);
  if (moved < 0) fail("cannot open another file", error);
  return moved;
}

/// Appends what comes until the writer closes.
/// @return what ended it; `exited` when the writer closed
End listen(int descriptor, const Errand& errand, Clock::time_point deadline,
           std::vector<char>& answer)
{
  std::vector<char> piece(1 << 20);
  while (true) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return End::took_too_long;
    pollfd awaited{descriptor, POLLIN, 0};
    if (::poll(&awaited, 1, static_cast<int>(std::min<long>(left + 1, 1 << 30))) <= 0) continue;
    const ssize_t n = ::read(descriptor, piece.data(), piece.size());
    if (n == 0 || (n < 0 && errno != EINTR)) return End::exited;
    if (n > 0) answer.insert(answer.end(), piece.data(), piece.data() + n);
    if (answer.size() > errand.most_bytes) return End::said_too_much;
  }
}

struct Ended {
  int status;
  bool in_time;
};

/// Waits for the end of a program that has closed its answer, and kills one that lingers.
Ended end_of(pid_t child, Clock::time_point deadline)
{
  Ended ended{.status = 0, .in_time = true};
  while (true) {
    const pid_t waited = ::waitpid(child, &ended.status, WNOHANG);
    if (waited == child) return ended;
    if (waited < 0 && errno != EINTR) return ended;  // somebody else waited for all children
    if (Clock::now() > deadline) {
      ended.in_time = false;
      ::kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace

Outcome run(const Errand& errand)
{
  const Descriptor question{above_the_given(::memfd_create("question", MFD_CLOEXEC))};
  write_all(question.get(), errand.question);
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("cannot open a pipe", errno);
  const Descriptor answer{ends[0]};
  Descriptor answering{above_the_given(ends[1])};
  const pid_t child = Surroundings(question.get(), answering.get()).start(errand.program.string());
  answering.reset();
  const auto limit = std::chrono::duration<double>(errand.most_seconds);
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(limit);
  Outcome outcome{.end = End::exited, .code = 0, .answer = {}};
  outcome.end = listen(answer.get(), errand, deadline, outcome.answer);
  if (outcome.end != End::exited) ::kill(child, SIGKILL);
  const Ended ended = end_of(child, deadline);
  if (outcome.end != End::exited) return outcome;
  outcome.end = !ended.in_time              ? End::took_too_long
                : WIFSIGNALED(ended.status) ? End::killed_by_signal
                                            : End::exited;
  outcome.code = WIFSIGNALED(ended.status) ? WTERMSIG(ended.status) : WEXITSTATUS(ended.status);
  return outcome;
}

}  // namespace chladni::confinement
