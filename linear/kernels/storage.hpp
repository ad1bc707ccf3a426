#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "common/petsc.hpp"

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

/// A dense matrix with the rows of A and zeros, for as many columns as make up a large part of the
/// memory: it takes room where something is written only. In a folder each rank has a file for its
/// rows (`GrowingMemory`).
/// @param folder  for scratch files; empty: the matrix is in memory
/// @note   Collective.
/// @throws chladni::Error on all ranks when one has no room for it.
petsc::Matrix large_dense(Mat A, PetscInt n_columns, const std::string& folder);

/// Room for numbers of this rank, all zero: in memory, or in a file in a folder.
/// @note   Collective.
/// @throws chladni::Error on all ranks when one has no room.
std::unique_ptr<GrowingMemory> room_for(double n_bytes, const std::string& folder, MPI_Comm comm);

/// Keeps the memory that a matrix refers to as long as the matrix lives.
void keep_with(Mat A, std::unique_ptr<GrowingMemory> memory);

/// The block that malloc gave stands before the numbers.
struct FreeAligned {
  void operator()(double* numbers) const { std::free(reinterpret_cast<void**>(numbers)[-1]); }
};

/// An array of doubles that begins at a cache line. Its memory is not touched before it is written.
using AlignedNumbers = std::unique_ptr<double, FreeAligned>;

/// Allocates n doubles. By malloc: glibc's aligned_alloc asks for more than it takes, so that an
/// array does not fit where one of the same size was before, and the heap grows.
/// @throws std::bad_alloc
inline AlignedNumbers aligned_numbers(std::size_t n)
{
  constexpr std::size_t line = 64;
  void* block = std::malloc(n * sizeof(double) + 2 * line);
  if (block == nullptr) throw std::bad_alloc();
  void* aligned = static_cast<void**>(block) + 1;
  std::size_t room = n * sizeof(double) + line;
  auto* numbers = static_cast<double*>(std::align(line, n * sizeof(double), aligned, room));
  reinterpret_cast<void**>(numbers)[-1] = block;
  return AlignedNumbers(numbers);
}

}  // namespace chladni::linear
