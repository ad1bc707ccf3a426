#pragma once

#include <cstddef>
#include <string>

namespace chladni::files {

/// Names a file that must not outlive this process, until the object ends: a file under its
/// temporary name, or the lock of an output. Its writer removes it; a signal that ends the process
/// in between removes it after `remove_unfinished_files_on_signals`.
class UnfinishedFile {
 public:
  /// Of more than 64 files at a time, or of a longer name than 4095 bytes, a signal leaves one
  /// behind; the next run removes it.
  explicit UnfinishedFile(const std::string& path);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

 private:
  std::size_t slot_;
};

/// For programs: SIGINT, SIGTERM and SIGHUP remove what is unfinished before they end the process
/// as they would have done; a file that grows beyond its limit is an error like a full disk. A
/// signal that the process was started to ignore stays ignored.
void remove_unfinished_files_on_signals();

}  // namespace chladni::files
