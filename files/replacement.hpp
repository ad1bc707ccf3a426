#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "files/output_lock.hpp"
#include "files/unfinished_file.hpp"

namespace chladni::files {

/// "; the older file is left as it was", where there is one, for the words of an error.
std::string older_file_stays(const std::string& path);

/// A file that is written under a temporary name beside its target and then takes the name of it. A
/// program that stops before leaves the old file, never half of a new one. The temporary file is a
/// new one of a name by chance, so that it is neither another process's nor a link that somebody
/// has put there; nobody else writes the target meanwhile (output_lock.hpp). All files of Chladni
/// are written so, but for those that are streams: what goes there, is there.
class Replacement {
 public:
  /// @throws chladni::Error when the target cannot be written.
  explicit Replacement(std::string path);
  /// Removes the temporary file when there was no commit.
  ~Replacement();
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  const std::string& path() const { return path_; }
  const std::string& temporary() const { return temporary_; }

  /// Appends to the temporary file.
  /// @throws chladni::Error when not all of it can be written.
  void write(std::string_view bytes);
  /// Flushes to disk, renames, and flushes the folder.
  /// @throws chladni::Error when that fails; the old file is left as it was.
  void commit();
  /// What `commit` throws, with the reason in `errno`.
  [[noreturn]] void fail() const;

 private:
  std::string path_;
  std::shared_ptr<const files::OutputLock> lock_;  ///< nothing for a stream
  std::string temporary_;                          ///< the stream itself
  std::optional<files::UnfinishedFile> unfinished_;
  int descriptor_ = -1;
};

}  // namespace chladni::files
