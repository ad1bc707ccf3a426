#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "files/unfinished_file.hpp"

namespace chladni::files {

/// Keeps other processes from writing a file: an advisory lock (flock) on `.NAME.lock` beside it,
/// which is gone at the end. A file system without such locks keeps nobody off.
class OutputLock {
 public:
  /// Use `lock_output`.
  explicit OutputLock(const std::filesystem::path& target);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  void acquire(const std::string& target);
  /// A disk that is full before the work is an error before the work.
  void try_room(const std::string& target) const;
  /// Temporary files of `target` without a living writer.
  void remove_orphans(const std::filesystem::path& target) const;

  std::string path_;
  int descriptor_ = -1;
  bool is_held_ = false;  ///< false where there are no locks
  std::optional<UnfinishedFile> unfinished_;
};

/// What a file is called until it is whole: NAME.tmp- and 12 hexadecimal digits by chance.
std::string temporary_name(const std::string& path);

/// Whether `path` is a device, a pipe or the like, into which one writes at once.
bool is_stream(const std::filesystem::path& path);

/// Makes sure that `path` can be written, and that no other process does so as long as the result
/// lives; removes what runs that were killed have left under temporary names. Within a process the
/// lock is shared, so that a program may take it before its costly work.
/// @return nothing for a stream
/// @throws chladni::Error when the folder cannot be written, `path` is a folder, or another process
///         has the lock.
std::shared_ptr<const OutputLock> lock_output(const std::filesystem::path& path);

}  // namespace chladni::files
