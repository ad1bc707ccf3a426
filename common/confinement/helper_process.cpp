#include "common/confinement/helper_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <thread>

#include "common/confinement/sandbox.hpp"
#include "common/error.hpp"

namespace chladni::confinement {

namespace {

namespace fs = std::filesystem;

/// "CHLADNI_MESHER" for "chladni-mesher".
std::string variable_of(std::string name)
{
  std::ranges::transform(name, name.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::toupper(c));
  });
  return name;
}

std::vector<fs::path> folders_of_path()
{
  const char* said = std::getenv("PATH");
  std::istringstream all(said == nullptr ? "" : said);
  std::vector<fs::path> folders;
  for (std::string folder; std::getline(all, folder, ':');)
    if (fs::path(folder).is_absolute()) folders.emplace_back(folder);
  return folders;
}

std::vector<char> read_question()
{
  std::vector<char> bytes;
  std::array<char, 4096> piece{};
  while (true) {
    const ssize_t n = ::read(STDIN_FILENO, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return bytes;
    bytes.insert(bytes.end(), piece.data(), piece.data() + n);
  }
}

/// @return whether all was said
bool say(const std::vector<char>& bytes)
{
  std::size_t said = 0;
  while (said < bytes.size()) {
    const ssize_t n = ::write(answer_descriptor, bytes.data() + said, bytes.size() - said);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) said += static_cast<std::size_t>(n);
  }
  return true;
}

const std::string version = CHLADNI_VERSION;

void require_same_version(Unpacker& question)
{
  std::string asking;
  question(asking);
  if (asking != version) {
    throw Error(fmt::format("{} is of Chladni {}, but Chladni {} asks it; install both together",
                            program_invocation_short_name, version, asking));
  }
}

}  // namespace

fs::path helper(const std::string& name)
{
  const std::string variable = variable_of(name);
  std::error_code ignored;
  if (const char* said = std::getenv(variable.c_str())) {
    if (fs::exists(said, ignored)) return said;
    throw Error(fmt::format("{} names {}, which is not there; give the path of {}, or unset it",
                            variable, said, name));
  }
  const fs::path here = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const fs::path beside = (here / "../libexec/chladni").lexically_normal();
  const fs::path installed = CHLADNI_LIBEXEC_FOLDER / fs::path("chladni");
  std::vector<fs::path> folders{beside, installed};
  for (const fs::path& programs : folders_of_path())
    folders.push_back(programs / "../libexec/chladni");
  for (const fs::path& folder : folders)
    if (fs::exists(folder / name, ignored)) return folder / name;
  throw Error(
      fmt::format("the program {} is neither in {} nor in {}, nor does PATH have the folder of the "
                  "chladni that it belongs to; install it, or set {} to its path",
                  name, beside.string(), installed.string(), variable));
}

void ask(const Errand& errand, const std::function<std::string(const Outcome&)>& explain,
         const std::function<void(Unpacker&)>& unpack)
{
  Packer begin;
  begin(version);
  Errand sent = errand;
  sent.question.insert(sent.question.begin(), begin.bytes().begin(), begin.bytes().end());
  const Outcome outcome = run(sent);
  if (outcome.end != End::exited || outcome.code != 0) throw Error(explain(outcome));
  Unpacker answer(outcome.answer);
  bool is_there = false;
  answer(is_there);
  if (is_there) return unpack(answer);
  std::string message;
  answer(message);
  throw Error(message);
}

void serve(const std::function<void(Unpacker& question, Packer& answer)>& work)
{
  end_with_caller();
  Packer answer;
  try {
    const std::vector<char> bytes = read_question();
    Unpacker question(bytes);
    require_same_version(question);
    answer(true);
    work(question, answer);
  } catch (const Error& error) {
    answer = Packer{};
    answer(false);
    answer(std::string(error.what()));
  }
  // Destructors of libraries at exit are not for what a file may have damaged.
  _exit(say(answer.bytes()) ? 0 : 1);
}

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
