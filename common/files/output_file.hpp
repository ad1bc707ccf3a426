#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace chladni::files {

/// Registers, during its lifetime, a file that must not outlive this process: a file under its
/// temporary name, or the lock of an output. Its writer removes it; if a signal ends the process,
/// the handlers of `remove_unfinished_files_on_signals` do.
class UnfinishedFile {
 public:
  /// Beyond 64 files at a time, or for a name longer than 4095 bytes, a signal leaves the file
  /// behind; the next run removes it.
  explicit UnfinishedFile(const std::string& path);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

 private:
  std::size_t slot_;
};

/// Makes SIGINT, SIGTERM and SIGHUP remove unfinished files before they end the process as usual. A
/// file that exceeds its size limit becomes an error like a full disk. Signals that the process
/// ignores from its start stay ignored. For programs.
void remove_unfinished_files_on_signals();

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

/// The end of an error message, "; the older file is left as it was", if there is an older file;
/// else empty.
std::string older_file_stays(const std::string& path);

/// A file that is written under a temporary name beside its target and then renamed to it. A
/// program that stops before the end leaves the old file, never half of a new one. The temporary
/// name is random and the file is new, so that it is neither another process's nor a link that
/// somebody has put there; the target is locked meanwhile (output_lock.hpp). All files of Chladni
/// are written so, except streams, which are written directly.
class Replacement {
 public:
  /// @throws chladni::Error when the target cannot be written.
  explicit Replacement(std::string path);
  /// Removes the temporary file if there was no commit.
  ~Replacement();
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  const std::string& path() const { return path_; }
  const std::string& temporary() const { return temporary_; }

  /// Appends to the temporary file.
  /// @throws chladni::Error when not all bytes can be written.
  void write(std::string_view bytes);
  /// Flushes to disk, renames, and flushes the folder.
  /// @throws chladni::Error when that fails; the old file is left as it was.
  void commit();
  /// Throws the error of `commit`, with the reason in `errno`.
  [[noreturn]] void fail() const;

 private:
  std::string path_;
  /// null for a stream
  std::shared_ptr<const files::OutputLock> lock_;
  std::string temporary_;  ///< for a stream the stream itself
  std::optional<files::UnfinishedFile> unfinished_;
  int descriptor_ = -1;
};

/// Writes `text` completely or not at all (replacement.hpp).
/// @throws chladni::Error when the file cannot be written; an older file is left as it was.
void write_text(const std::string& path, std::string_view text);

}  // namespace chladni::files
