#pragma once

#include <string>

namespace chladni::files {

/// A file that is written under a temporary name beside its target and then takes the name of it. A
/// program that stops before leaves the old file, never half of a new one.
class Replacement {
 public:
  explicit Replacement(std::string path);
  /// Removes the temporary file when there was no commit.
  ~Replacement();
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  const std::string& path() const { return path_; }
  const std::string& temporary() const { return temporary_; }

  /// Flushes to disk and renames.
  /// @throws chladni::Error when that fails; the old file is left as it was.
  void commit();
  /// What `commit` throws, with the reason in `errno`.
  [[noreturn]] void fail() const;

 private:
  std::string path_;
  std::string temporary_;
  bool is_committed_ = false;
};

}  // namespace chladni::files
