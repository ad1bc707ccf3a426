#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "squeal/motion/state_archive.hpp"

namespace chladni::squeal {

/// Inputs of a run; only a run with the same inputs can continue an interrupted one.
struct RunOrigin {
  mbs_export::Provenance provenance;  ///< provenance of the results
  std::string inputs;                 ///< digests of the input files, and versions of the programs
};

/// The state of a long transient in a file, from which an interrupted run continues. It is written
/// periodically, as a whole (common/files/output_file.hpp), and removed when the run ends successfully.
class Checkpoint {
 public:
  /// @param interval  wall time between two writes, s
  Checkpoint(std::filesystem::path file, RunOrigin origin, double interval);

  /// Reads the state in the file, with which the run will start.
  /// @return the origin of the run that wrote it
  /// @throws chladni::Error when the file is missing or damaged.
  RunOrigin read();

  /// Restores the state that was read, once.
  /// @param exchange  passes the members of the state to an archive
  /// @return whether there was a state
  /// @throws chladni::Error when the state does not fit the members.
  template <class Exchange>
  bool give_back(const Exchange& exchange)
  {
    if (state_.empty()) return false;
    StateArchive archive(std::exchange(state_, {}));
    exchange(archive);
    archive.expect_end();
    return true;
  }

  /// Whether the interval has passed since the last write.
  bool is_due() const;
  bool was_written() const { return was_written_; }
  /// Why the last write failed; empty when it did not.
  const std::string& failure() const { return failure_; }
  /// Writes the state. If that fails, the previous file remains, and the next attempt is made after
  /// the interval.
  /// @param exchange  passes the members of the state to an archive
  template <class Exchange>
  void keep(const Exchange& exchange)
  {
    StateArchive archive;
    exchange(archive);
    write(archive.words());
  }

  /// Removes the file.
  void remove() const;

 private:
  void write(const std::vector<std::int64_t>& state);
  void write_file(const std::vector<std::int64_t>& state) const;

  std::filesystem::path file_;
  RunOrigin origin_;
  std::chrono::duration<double> interval_;
  std::chrono::steady_clock::time_point last_;
  std::vector<std::int64_t> state_;
  bool was_written_ = false;
  std::string failure_;
};

}  // namespace chladni::squeal
