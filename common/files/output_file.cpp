#include "common/files/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <string_view>
#include <system_error>

#include "common/error.hpp"

namespace chladni::files {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t n_digits = 12;

/// O_NONBLOCK: somebody may have put a pipe there.
constexpr int lock_flags = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;

/// Another user's lock, left behind in a shared folder, can be read as a rule, and so taken.
int open_lock(const std::string& path)
{
  const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | lock_flags, 0666);
  if (descriptor >= 0 || errno != EACCES) return descriptor;
  const int readable = open(path.c_str(), O_RDONLY | lock_flags);
  if (readable < 0) errno = EACCES;
  return readable;
}

/// Whether the open file is still the one of that name, which its last holder may have removed.
bool has_name(int descriptor, const std::string& path)
{
  struct stat opened {};
  struct stat named {};
  return fstat(descriptor, &opened) == 0 && lstat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

[[noreturn]] void refuse_output(const std::string& target, int reason)
{
  throw Error(
      fmt::format("{}: cannot be written ({}); does its folder exist, may you write there, and is "
                  "there room?",
                  target, std::strerror(reason)));
}

fs::path absolute_name(const fs::path& path)
{
  const fs::path whole = fs::absolute(path);
  return fs::weakly_canonical(whole.parent_path()) / whole.filename();
}

}  // namespace

OutputLock::OutputLock(const fs::path& target)
    : path_((target.parent_path() / fmt::format(".{}.lock", target.filename().string())).string())
{
  acquire(target.string());
  if (is_held_) try_room(target.string());
  unfinished_.emplace(path_);
  if (is_held_) remove_orphans(target);
}

OutputLock::~OutputLock()
{
  unfinished_.reset();  // from here on the name may be another process's
  unlink(path_.c_str());
  close(descriptor_);
}

void OutputLock::acquire(const std::string& target)
{
  do {
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = open_lock(path_);
    if (descriptor_ < 0) refuse_output(target, errno);
    is_held_ = flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    if (!is_held_ && errno == EWOULDBLOCK) {
      close(descriptor_);
      throw Error(fmt::format(
          "{}: another run is writing this file; wait for its end, or write elsewhere (--output)",
          target));
    }
  } while (is_held_ && !has_name(descriptor_, path_));
  if (access(fs::path(target).parent_path().c_str(), W_OK | X_OK) == 0) return;
  const int reason = errno;
  close(descriptor_);
  refuse_output(target, reason);
}

void OutputLock::try_room(const std::string& target) const
{
  constexpr std::array<char, 4096> page{};
  const ssize_t n = pwrite(descriptor_, page.data(), page.size(), 0);
  const int reason = n < 0 ? errno : 0;
  if (n > 0 && ftruncate(descriptor_, 0) != 0) return;  // it is removed soon
  if (reason != ENOSPC && reason != EDQUOT && reason != EFBIG) return;
  unlink(path_.c_str());
  close(descriptor_);
  refuse_output(target, reason);
}

void OutputLock::remove_orphans(const fs::path& target) const
{
  const std::string begin = target.filename().string() + ".tmp-";
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(target.parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    const bool is_temporary =
        name.starts_with(begin) && name.size() == begin.size() + n_digits &&
        name.find_first_not_of("0123456789abcdef", begin.size()) == std::string::npos;
    if (is_temporary && entry.is_regular_file(ignored)) fs::remove(entry.path(), ignored);
  }
}

std::string temporary_name(const std::string& path)
{
  std::uint64_t number = 0;
  if (getentropy(&number, sizeof number) != 0) refuse_output(path, errno);
  return fmt::format("{}.tmp-{:0{}x}", path, number >> 16U, n_digits);
}

bool is_stream(const fs::path& path)
{
  std::error_code ignored;
  // /dev/stdout, also where the shell has led it into a file.
  const bool is_descriptor = fs::read_symlink(path, ignored).string().starts_with("/proc/");
  return is_descriptor || fs::is_other(path, ignored);
}

std::shared_ptr<const OutputLock> lock_output(const fs::path& path)
{
  if (is_stream(path)) return nullptr;
  if (fs::is_directory(path))
    throw Error(fmt::format("{}: is a folder; name a file", path.string()));
  static std::mutex mutex;
  static std::map<fs::path, std::weak_ptr<const OutputLock>> locks;
  const std::scoped_lock guard(mutex);
  const fs::path target = absolute_name(path);
  if (std::shared_ptr<const OutputLock> held = locks[target].lock()) return held;
  auto lock = std::make_shared<const OutputLock>(target);
  locks[target] = lock;
  return lock;
}

namespace {

/// The new name on disk, so that a power cut cannot bring the old file back. Folders that cannot be
/// flushed are the file system's business.
void synchronise_folder_of(const std::string& path)
{
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  const bool is_broken = fsync(descriptor) != 0 && errno == EIO;
  close(descriptor);
  if (is_broken) {
    throw Error(fmt::format("{}: is written, but its folder cannot be flushed to disk ({})", path,
                            std::strerror(EIO)));
  }
}

}  // namespace

std::string older_file_stays(const std::string& path)
{
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) ? "; the older file is left as it was" : "";
}

Replacement::Replacement(std::string path)
    : path_(std::move(path)),
      lock_(files::lock_output(path_)),
      temporary_(lock_ ? files::temporary_name(path_) : path_)
{
  if (lock_) unfinished_.emplace(temporary_);
  const int creation = lock_ ? O_CREAT | O_EXCL | O_NOFOLLOW : O_APPEND;
  descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CLOEXEC | creation, 0666);
  if (descriptor_ < 0) fail();
}

Replacement::~Replacement()
{
  if (unfinished_) std::remove(temporary_.c_str());
  close(descriptor_);
}

void Replacement::write(std::string_view bytes)
{
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail();
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void Replacement::commit()
{
  if (!lock_) return;
  if (fsync(descriptor_) != 0 || std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
  unfinished_.reset();
  synchronise_folder_of(path_);
}

void Replacement::fail() const
{
  throw Error(fmt::format("{}: cannot be completed ({}){}", path_, std::strerror(errno),
                          lock_ ? older_file_stays(path_) : ""));
}

namespace {

enum class Use { none, changing, named };

/// Static memory: a handler of signals may look at it at any time, and nothing is ever freed.
struct Slot {
  std::atomic<Use> use{Use::none};
  std::array<char, 4096> path{};
};
std::array<Slot, 64> slots;
static_assert(std::atomic<Use>::is_always_lock_free);  // what a handler may use

std::atomic<pid_t> owner{0};

/// The files belong to the process that asked for this, not to those that it forks.
void remove_and_end(int number)
{
  for (const Slot& slot : slots)
    if (getpid() == owner && slot.use == Use::named) unlink(slot.path.data());
  std::signal(number, SIG_DFL);
  std::raise(number);
}

}  // namespace

UnfinishedFile::UnfinishedFile(const std::string& path) : slot_(0)
{
  if (path.size() >= slots[0].path.size()) slot_ = slots.size();
  for (; slot_ < slots.size(); ++slot_) {
    Use expected = Use::none;
    if (!slots[slot_].use.compare_exchange_strong(expected, Use::changing)) continue;
    std::memcpy(slots[slot_].path.data(), path.c_str(), path.size() + 1);
    slots[slot_].use = Use::named;
    return;
  }
}

UnfinishedFile::~UnfinishedFile()
{
  if (slot_ < slots.size()) slots[slot_].use = Use::none;
}

void remove_unfinished_files_on_signals()
{
  owner = getpid();
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    sigaction(number, nullptr, &action);
    if (action.sa_handler == SIG_IGN) continue;  // nohup
    action.sa_handler = remove_and_end;
    action.sa_flags = 0;
    sigaction(number, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

void write_text(const std::string& path, std::string_view text)
{
  Replacement file(path);
  file.write(text);
  file.commit();
}

}  // namespace chladni::files
