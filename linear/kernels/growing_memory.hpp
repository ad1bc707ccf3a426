#pragma once

#include <cstddef>

namespace chladni::linear {

/// An array of doubles that grows without a copy and takes memory only where it is touched,
/// whatever the settings of malloc are. SuperLU_DIST, part of many builds of PETSc, forbids malloc
/// to map large blocks; a block that grows is then copied and exists twice.
class GrowingMemory {
 public:
  GrowingMemory() = default;
  ~GrowingMemory() { release(); }
  GrowingMemory(GrowingMemory&& other) noexcept : values_(other.values_), n_bytes_(other.n_bytes_)
  {
    other.values_ = nullptr;
    other.n_bytes_ = 0;
  }
  GrowingMemory& operator=(GrowingMemory&&) = delete;

  /// Makes room for n numbers; existing ones are kept.
  /// @return false if there is not enough memory
  [[nodiscard]] bool grow(std::size_t n);
  double* get() const { return values_; }

 private:
  void release();

  double* values_ = nullptr;
  std::size_t n_bytes_ = 0;
};

}  // namespace chladni::linear
