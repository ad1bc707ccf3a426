#include "linear/kernels/growing_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>

namespace chladni::linear {

namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr bool maps_memory = false;  // malloc: sanitizers see who reads beyond its end
#else
constexpr bool maps_memory = true;
#endif

/// Not every file system knows files without a name.
int open_without_name(const std::string& folder)
{
  const int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file >= 0) return file;
  std::string name = (std::filesystem::path(folder) / "chladni-XXXXXX").string();
  const int named = mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) unlink(name.c_str());
  return named;
}

}  // namespace

/// Takes the room now: where a disk is full, a page without room would end the process.
bool GrowingMemory::has_room_on_disk(std::size_t n_bytes)
{
  if (file_ < 0) file_ = open_without_name(folder_);
  return file_ >= 0 && std::cmp_less_equal(n_bytes, std::numeric_limits<off_t>::max()) &&
         posix_fallocate(file_, 0, static_cast<off_t>(n_bytes)) == 0;
}

/// nullptr when there is none.
void* GrowingMemory::larger(std::size_t n_bytes) const
{
  const bool is_file = !folder_.empty();
  if (!is_file && !maps_memory) return std::realloc(values_, n_bytes);
  const int kind = is_file ? MAP_SHARED : MAP_PRIVATE | MAP_ANONYMOUS;
  void* memory = values_ == nullptr ? mmap(nullptr, n_bytes, PROT_READ | PROT_WRITE, kind, file_, 0)
                                    : mremap(values_, n_bytes_, n_bytes, MREMAP_MAYMOVE);
  return memory == MAP_FAILED ? nullptr : memory;
}

bool GrowingMemory::grow(std::size_t n)
{
  const std::size_t n_bytes = std::max<std::size_t>(n, 1) * sizeof(double);
  if (n_bytes <= n_bytes_) return true;
  if (!folder_.empty() && !has_room_on_disk(n_bytes)) return false;
  void* memory = larger(n_bytes);
  if (memory == nullptr) return false;
  values_ = static_cast<double*>(memory);
  const bool is_mapped = !folder_.empty() || maps_memory;
  if (!is_mapped) std::fill(values_ + n_bytes_ / sizeof(double), values_ + n, 0.0);
  n_bytes_ = n_bytes;
  return true;
}

void GrowingMemory::take_small_pages() const
{
  if (folder_.empty() && maps_memory) madvise(values_, n_bytes_, MADV_NOHUGEPAGE);
}

void GrowingMemory::release()
{
  const bool is_mapped = !folder_.empty() || maps_memory;
  if (values_ != nullptr && is_mapped) munmap(values_, n_bytes_);
  if (values_ != nullptr && !is_mapped) std::free(values_);
  if (file_ >= 0) close(file_);
}

}  // namespace chladni::linear
