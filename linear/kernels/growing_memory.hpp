#pragma once

#include <cstddef>

namespace chladni::linear {

/// Storage for numbers that grows without a copy and takes memory where it is touched, whatever a
/// process has told malloc: SuperLU_DIST, a part of many builds of PETSc, forbids it to map large
/// blocks, and then one that grows is copied and stands there twice.
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

  /// Room for n numbers; those that are there stay. Whether there is memory for so many.
  [[nodiscard]] bool grow(std::size_t n);
  double* get() const { return values_; }

 private:
  void release();

  double* values_ = nullptr;
  std::size_t n_bytes_ = 0;
};

}  // namespace chladni::linear
