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

/// What a run is made from; another one cannot go on where this one was interrupted.
struct RunOrigin {
  mbs_export::Provenance provenance;  ///< of the results
  std::string inputs;  ///< digests of the files that it reads, and versions of the programs
};

/// The state of a long transient in a file, from which a run that was interrupted goes on. It is
/// written now and then, as a whole (files/replacement.hpp), and removed when the run ends well.
class Checkpoint {
 public:
  /// @param interval  of the clock on the wall between two states, s
  Checkpoint(std::filesystem::path file, RunOrigin origin, double interval);

  /// The state in the file, from now on the one to begin with.
  /// @return the origin of the run that wrote it
  /// @throws chladni::Error when the file is damaged or none.
  RunOrigin read();

  /// Gives back, once, the state that was read.
  /// @param exchange  names the members of the state to an archive
  /// @return whether there was one
  /// @throws chladni::Error when it is the state of something else.
  template <class Exchange>
  bool give_back(const Exchange& exchange)
  {
    if (state_.empty()) return false;
    StateArchive archive(std::exchange(state_, {}));
    exchange(archive);
    archive.expect_end();
    return true;
  }

  /// Whether the interval has passed since the last state.
  bool is_due() const;
  bool was_written() const { return was_written_; }
  /// Why the last state could not be written; empty when it was.
  const std::string& failure() const { return failure_; }
  /// Writes the state. Where that fails the last one stays, and after the interval there is another
  /// try.
  template <class Exchange>
  void keep(const Exchange& exchange)
  {
    StateArchive archive;
    exchange(archive);
    write(archive.words());
  }

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
