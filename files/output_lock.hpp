#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "files/unfinished_file.hpp"

namespace chladni::files {

/// Keeps other processes from writing a file, by an advisory lock (flock) on `.NAME.lock` beside
/// it, which is removed at the end. On a file system without such locks it has no effect.
class OutputLock {
 public:
  /// Use `lock_output` instead.
  explicit OutputLock(const std::filesystem::path& target);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  void acquire(const std::string& target);
  /// Fails before the work if the disk is full.
  void try_room(const std::string& target) const;
  /// Removes temporary files of `target` that have no living writer.
  void remove_orphans(const std::filesystem::path& target) const;

  std::string path_;
  int descriptor_ = -1;
  bool is_held_ = false;  ///< false if the file system has no locks
  std::optional<UnfinishedFile> unfinished_;
};

/// The name of a file until it is complete: NAME.tmp- and 12 random hexadecimal digits.
std::string temporary_name(const std::string& path);

/// True if `path` is a device, a pipe or the like, which is written directly.
bool is_stream(const std::filesystem::path& path);

/// Checks that `path` can be written and locks it against other processes during the lifetime of
/// the result. Removes temporary files that killed runs have left. Within a process the lock is
/// shared, so that a program can take it before its costly work.
/// @return null for a stream
/// @throws chladni::Error when the folder cannot be written, `path` is a folder, or another process
///         has the lock.
std::shared_ptr<const OutputLock> lock_output(const std::filesystem::path& path);

}  // namespace chladni::files
