#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace chladni::linear {

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
