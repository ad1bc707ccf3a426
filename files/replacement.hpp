#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "files/output_lock.hpp"
#include "files/unfinished_file.hpp"

namespace chladni::files {

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

}  // namespace chladni::files
