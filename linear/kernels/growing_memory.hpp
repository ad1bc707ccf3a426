#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace chladni::linear {

/// What an array lacks to grow, the worse the greater.
enum class Lack { none, memory, addresses, disk };

/// A sentence about it and what to do: "no memory for {what}; ...".
/// @param less    what to ask for, "ask for fewer modes"
/// @param folder  of scratch files
std::string told(Lack lack, const std::string& what, const std::string& less,
                 const std::string& folder);

/// An array of doubles that grows without a copy and takes memory only where it is touched,
/// whatever the settings of malloc are. SuperLU_DIST, part of many builds of PETSc, forbids malloc
/// to map large blocks; a block that grows is then copied and exists twice.
///
/// With a folder the array is a file there, without a name, so that it vanishes with the process.
/// The system keeps in memory what fits, and writes and reads the rest.
class GrowingMemory {
 public:
  /// @param folder  of the file; empty: none
  explicit GrowingMemory(std::string folder = {}) : folder_(std::move(folder)) {}
  ~GrowingMemory() { release(); }
  GrowingMemory(GrowingMemory&& other) noexcept
      : folder_(std::move(other.folder_)),
        file_(std::exchange(other.file_, -1)),
        values_(std::exchange(other.values_, nullptr)),
        n_bytes_(std::exchange(other.n_bytes_, 0))
  {}
  GrowingMemory& operator=(GrowingMemory&&) = delete;

  /// Makes room for n numbers; existing ones are kept, others are zero.
  /// @return what lacks, if there is not enough memory, no room for the file, or no addresses left
  ///         (`ulimit -v`)
  [[nodiscard]] Lack grow(std::size_t n);
  double* get() const { return values_; }
  /// Memory is taken in the smallest pages, so that what is never touched between others is not
  /// taken with them.
  void take_small_pages() const;

 private:
  bool has_room_on_disk(std::size_t n_bytes);
  void* larger(std::size_t n_bytes) const;
  void release();

  std::string folder_;
  int file_ = -1;
  double* values_ = nullptr;
  std::size_t n_bytes_ = 0;
};

}  // namespace chladni::linear
