// Files that claim more than they hold, or unpack to more than they claim, each of them without a
// seal and with one: they take memory and time that befit their size.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "common/files/hdf5.hpp"
#include "common/files/trial_reading.hpp"
#include "hostile_file.hpp"

namespace chladni::files {
namespace {

using test::all_seals, test::contains, test::dataset_properties, test::error_of,
    test::expect_refusal, test::make_file, test::make_x, test::MiB, test::ScratchFolder,
    test::Sealed;

std::size_t peak_memory()
{
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return std::size_t(used.ru_maxrss) * 1024;
}

/// "x" of n_chunks MiB of zeros; `level` of deflate 1 packs them into about a two hundredth.
void pack_zeros(hid_t file, hsize_t n_chunks)
{
  const Handle creation = dataset_properties();
  const hsize_t n = MiB / sizeof(double);
  H5Pset_chunk(creation.get(), 1, &n);
  H5Pset_deflate(creation.get(), 1);
  const Handle x = make_x(file, n_chunks * n, creation);
  const Handle memory{H5Screate_simple(1, &n, nullptr), H5Sclose},
      place{H5Dget_space(x.get()), H5Sclose};
  const std::vector<double> zeros(n);
  hsize_t offset = 0, size = 0;
  H5Sselect_hyperslab(place.get(), H5S_SELECT_SET, &offset, nullptr, &n, nullptr);
  H5Dwrite(x.get(), H5T_NATIVE_DOUBLE, memory.get(), place.get(), H5P_DEFAULT, zeros.data());
  H5Dflush(x.get());
  H5Dget_chunk_storage_size(x.get(), &offset, &size);
  std::vector<char> packed(size);
  std::uint32_t filters = 0;
  H5Dread_chunk(x.get(), H5P_DEFAULT, &offset, &filters, packed.data());
  for (offset = n; offset < n_chunks * n; offset += n)
    H5Dwrite_chunk(x.get(), H5P_DEFAULT, 0, &offset, size, packed.data());
}

TEST(PackedFile, ClaimsNoMoreMemoryThanBefitsItsSize)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  for (const Sealed sealed : all_seals) {
    make_file(path, sealed, [](hid_t file) { pack_zeros(file, 1024); });
    ASSERT_LT(std::filesystem::file_size(path), 10 * MiB);
    const std::size_t before = peak_memory();
    const std::string error = error_of([&] { Reader(path).vector("x"); });
    EXPECT_TRUE(contains(error, ": x: claims 134217728 values")) << error;
    EXPECT_LT(peak_memory(), before + 64 * MiB);
  }
}

/// One chunk that says it holds 128 values and unpacks to 256 MiB.
void pack_more_than_said(hid_t file, const std::string& packed)
{
  const Handle creation = dataset_properties();
  const hsize_t n = 128;
  H5Pset_chunk(creation.get(), 1, &n);
  H5Pset_deflate(creation.get(), 9);
  const Handle x = make_x(file, n, creation);
  const hsize_t offset = 0;
  H5Dwrite_chunk(x.get(), H5P_DEFAULT, 0, &offset, packed.size(), packed.data());
}

/// zlib's stream of `size` zeros, out of a file of HDF5.
std::string packed_zeros(const ScratchFolder& folder, hsize_t size)
{
  std::string packed;
  make_file(folder.file("zeros.h5"), Sealed::not_at_all, [&](hid_t file) {
    const Handle creation = dataset_properties();
    const hsize_t n = size / sizeof(double), offset = 0;
    H5Pset_chunk(creation.get(), 1, &n);
    H5Pset_deflate(creation.get(), 9);
    const Handle x = make_x(file, n, creation);
    const std::vector<double> zeros(n);
    H5Dwrite(x.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data());
    H5Dflush(x.get());
    hsize_t n_packed = 0;
    std::uint32_t filters = 0;
    H5Dget_chunk_storage_size(x.get(), &offset, &n_packed);
    packed.resize(n_packed);
    H5Dread_chunk(x.get(), H5P_DEFAULT, &offset, &filters, packed.data());
  });
  return packed;
}

TEST(PackedFile, UnpacksToNoMoreThanBefitsItsSize)
{
#ifdef CHLADNI_SANITIZED
  GTEST_SKIP() << "the sanitizer ends a process without memory in its own way";
#endif
  const ScratchFolder folder;
  const std::string packed = packed_zeros(folder, 256 * MiB);
  expect_refusal(folder, ": unpacks to more than 13",
                 [&](hid_t file) { pack_more_than_said(file, packed); });
}

TEST(PackedFile, GivesNoMoreThanBefitsItsSizeUnderManyNames)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  Writer writer(path);
  writer.write("x", Eigen::VectorXd::Zero(Eigen::Index(MiB / sizeof(double))), "m");
  writer.commit();
  const Reader reader(path);
  const auto read = [&](int n) {
    for (int i = 0; i < n; ++i) reader.vector("x");
  };
  EXPECT_EQ(error_of([&] { read(144); }), "");  // 16 sizes and 128 MiB
  EXPECT_TRUE(contains(error_of([&] { read(1); }), ": x: claims 131072 values"));
}

TEST(Trial, EndsInTime)
{
  const ScratchFolder folder;
  ASSERT_EQ(mkfifo(folder.file("fifo").c_str(), 0600), 0);  // its opening waits for a writer
  const auto start = std::chrono::steady_clock::now();
  const auto refusal =
      refusal_of_trial(folder.file("fifo"), {.memory = 64 * MiB, .cpu_s = 5, .wall_s = 1});
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  ASSERT_TRUE(refusal);
  EXPECT_TRUE(contains(*refusal, "1 s on the clock")) << *refusal;
}

}  // namespace
}  // namespace chladni::files
