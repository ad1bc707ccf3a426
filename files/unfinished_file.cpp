#include "files/unfinished_file.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

namespace chladni::files {
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

}  // namespace chladni::files
