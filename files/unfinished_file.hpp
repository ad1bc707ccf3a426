#pragma once

#include <cstddef>
#include <string>

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

}  // namespace chladni::files
