#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace chladni::linear {

struct Free {
  void operator()(double* values) const { std::free(values); }
};

/// An array of doubles that begins at a cache line. Its memory is not touched before it is written.
using AlignedNumbers = std::unique_ptr<double, Free>;

/// Allocates n doubles.
/// @throws std::bad_alloc
inline AlignedNumbers aligned_numbers(std::size_t n)
{
  constexpr std::size_t line = 64;
  const std::size_t n_bytes = (n * sizeof(double) / line + 1) * line;
  AlignedNumbers numbers(static_cast<double*>(std::aligned_alloc(line, n_bytes)));
  if (!numbers) throw std::bad_alloc();
  return numbers;
}

}  // namespace chladni::linear
