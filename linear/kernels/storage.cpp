#include "linear/kernels/storage.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/machine_memory.hpp"

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

/// By `ulimit -v`.
bool addresses_are_limited()
{
  rlimit limit{};
  return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

}  // namespace

std::string told(Lack lack, const std::string& what, const std::string& less,
                 const std::string& folder)
{
  if (lack == Lack::disk) {
    return fmt::format(
        "the folder {} for scratch files has no room for {}; give another one by "
        "-cms_scratch, or {}",
        folder, what, less);
  }
  if (lack == Lack::addresses) {
    return fmt::format(
        "no memory for {}: the limit of this shell (ulimit -v) is reached; raise it, "
        "{}, or use more machines",
        what, less);
  }
  return fmt::format("no memory for {}; {}, use more machines{}", what, less,
                     folder.empty() ? ", or -cms_scratch" : "");
}

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

Lack GrowingMemory::grow(std::size_t n)
{
  const std::size_t n_bytes = std::max<std::size_t>(n, 1) * sizeof(double);
  if (n_bytes <= n_bytes_) return Lack::none;
  if (!folder_.empty() && !has_room_on_disk(n_bytes)) return Lack::disk;
  void* memory = larger(n_bytes);
  if (memory == nullptr) return addresses_are_limited() ? Lack::addresses : Lack::memory;
  values_ = static_cast<double*>(memory);
  const bool is_mapped = !folder_.empty() || maps_memory;
  if (!is_mapped) std::fill(values_ + n_bytes_ / sizeof(double), values_ + n, 0.0);
  n_bytes_ = n_bytes;
  return Lack::none;
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

void keep_with(Mat A, std::unique_ptr<GrowingMemory> memory)
{
  petsc::keep_with(reinterpret_cast<PetscObject>(A), "chladni_scratch", std::move(memory));
}

std::unique_ptr<GrowingMemory> room_for(double n_bytes, const std::string& folder, MPI_Comm comm)
{
  auto memory = std::make_unique<GrowingMemory>(folder);
  int lack = int(memory->grow(static_cast<std::size_t>(n_bytes / sizeof(double)) + 1));
  MPI_Allreduce(MPI_IN_PLACE, &lack, 1, MPI_INT, MPI_MAX, comm);
  MPI_Allreduce(MPI_IN_PLACE, &n_bytes, 1, MPI_DOUBLE, MPI_SUM, comm);
  if (Lack(lack) == Lack::none) return memory;
  throw Error(told(Lack(lack), fmt::format("{:.0f} MiB", std::ceil(n_bytes / bytes_in_MiB)),
                   "ask for fewer modes or masters", folder));
}

petsc::Matrix large_dense(Mat A, PetscInt n_columns, const std::string& folder)
{
  constexpr double worth_a_map = 1.0 * (1 << 20);
  PetscInt n_local = 0, n = 0;
  petsc::check(MatGetLocalSize(A, &n_local, nullptr));
  petsc::check(MatGetSize(A, &n, nullptr));
  const double n_bytes = sizeof(double) * double(n_local) * n_columns;
  const double all_bytes = sizeof(double) * double(n) * n_columns;
  if (folder.empty() && all_bytes < worth_a_map) {
    petsc::Matrix small = uninitialized_dense(A, n_columns);
    petsc::check(MatZeroEntries(small));
    return small;
  }
  std::unique_ptr<GrowingMemory> memory = room_for(n_bytes, folder, petsc::communicator(A));
  memory->take_small_pages();
  petsc::Matrix dense;
  petsc::check(MatCreateDense(petsc::communicator(A), n_local, PETSC_DECIDE, n, n_columns,
                              memory->get(), dense.put()));
  keep_with(dense, std::move(memory));
  return dense;
}

}  // namespace chladni::linear
