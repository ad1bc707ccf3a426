#include "linear/kernels/growing_memory.hpp"

#include <algorithm>
#include <cstdlib>

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
#include <sys/mman.h>
#define CHLADNI_MAPS_MEMORY
#endif

namespace chladni::linear {

namespace {

#ifdef CHLADNI_MAPS_MEMORY

/// nullptr when there is none.
void* larger(void* values, std::size_t n_now, std::size_t n_bytes)
{
  void* memory = values == nullptr ? mmap(nullptr, n_bytes, PROT_READ | PROT_WRITE,
                                          MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)
                                   : mremap(values, n_now, n_bytes, MREMAP_MAYMOVE);
  return memory == MAP_FAILED ? nullptr : memory;
}

void give_back(void* values, std::size_t n_bytes)
{
  munmap(values, n_bytes);
}

#else

/// From malloc, where sanitizers see who reads beyond the end.
void* larger(void* values, std::size_t /*n_now*/, std::size_t n_bytes)
{
  return std::realloc(values, n_bytes);
}

void give_back(void* values, std::size_t /*n_bytes*/)
{
  std::free(values);
}

#endif

}  // namespace

bool GrowingMemory::grow(std::size_t n)
{
  const std::size_t n_bytes = std::max<std::size_t>(n, 1) * sizeof(double);
  if (n_bytes <= n_bytes_) return true;
  void* memory = larger(values_, n_bytes_, n_bytes);
  if (memory == nullptr) return false;
  values_ = static_cast<double*>(memory);
  n_bytes_ = n_bytes;
  return true;
}

void GrowingMemory::release()
{
  if (values_ != nullptr) give_back(values_, n_bytes_);
}

}  // namespace chladni::linear
