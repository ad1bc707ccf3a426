#include "common/files/seal.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "common/files/hdf5.hpp"
#include "mbs_export/files/body_files.hpp"
#include "tests/common/files/scratch_folder.hpp"

namespace chladni::mbs_export::hdf5 {
namespace {

using files::test::ScratchFolder, files::test::bytes_of, files::test::error_of;

void put_bytes(const std::string& path, const std::string& bytes)
{
  std::ofstream(path, std::ios::binary) << bytes;
}

/// A file with n numbers; its bytes.
std::string sealed_bytes(const std::string& path, Eigen::Index n)
{
  files::Writer writer(path);
  writer.write("x", Eigen::VectorXd::LinSpaced(n, 0.0, 1.0), "m");
  writer.commit();
  return bytes_of(path);
}

bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

/// The bytes of HDF5 but for where its superblock (of version 0) says that it begins and ends.
std::string without_places(std::string hdf5)
{
  for (const std::size_t at : {24, 40}) hdf5.replace(at, 8, 8, '?');
  return hdf5;
}

/// Where the superblock of version 0 says that HDF5 begins.
std::uint64_t beginning_of(const std::string& hdf5)
{
  std::uint64_t place = 0;
  std::memcpy(&place, hdf5.data() + 24, sizeof place);
  return place;
}

/// Whether the seal speaks, and not libhdf5 or what reads with it.
bool is_refused_by_the_seal(const std::string& path)
{
  const std::string error = error_of([&] { files::Reader(path).vector("x"); });
  return contains(error, path) && (contains(error, "is not as it was written") ||
                                   contains(error, "is neither an HDF5 file nor"));
}

TEST(Seal, IsTextBeforeAFileOfHdf5)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  const std::string golden = bytes_of(CHLADNI_SOURCE_DIR "/tests/data/version_1.reduced.h5");
  put_bytes(path, golden);
  files::seal_file(path);
  EXPECT_EQ(beginning_of(bytes_of(path).substr(files::seal_size)), files::seal_size);
  EXPECT_EQ(without_places(bytes_of(path).substr(files::seal_size)), without_places(golden));
  const std::string seal = bytes_of(path).substr(0, files::seal_size);
  EXPECT_EQ(seal.substr(0, seal.find_last_not_of(" \n") + 1),
            "Chladni seal 1\n"
            "bytes 28872\n"
            "xxh64 dcdc114ec3f7af04 of all bytes behind these 512\n"
            "What follows is an HDF5 file. When you have changed it on purpose: chladni seal FILE");
}

TEST(Seal, FindsEachDamagedByteBeforeTheFileIsOpened)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5"), whole = sealed_bytes(path, 100);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string bytes = whole;
    bytes[i] ^= static_cast<char>(1 << (i % 8));
    put_bytes(path, bytes);
    ASSERT_TRUE(is_refused_by_the_seal(path)) << i;
  }
}

TEST(Seal, FindsThatAFileIsCutShortOrTooLong)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5"), whole = sealed_bytes(path, 100);
  for (std::size_t n = 0; n < whole.size(); n += n < 600 ? 1 : 37) {
    put_bytes(path, whole.substr(0, n));
    ASSERT_TRUE(is_refused_by_the_seal(path)) << n;
  }
  put_bytes(path, whole + '\0');
  EXPECT_TRUE(is_refused_by_the_seal(path));
}

// The digest is made of pieces of 256 KiB.
TEST(Seal, GuardsTheLastByteOfALargeFile)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5"), whole = sealed_bytes(path, 100000);
  EXPECT_EQ(files::Reader(path).vector("x").size(), 100000);
  for (const std::size_t at :
       {whole.size() - 1, files::seal_size + (1u << 18), files::seal_size + (1u << 18) - 1}) {
    std::string bytes = whole;
    ++bytes[at];
    put_bytes(path, bytes);
    EXPECT_TRUE(is_refused_by_the_seal(path)) << at;
  }
}

TEST(Seal, ErrorSaysHowToAcceptAChange)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5"), whole = sealed_bytes(path, 100);
  put_bytes(path, whole.substr(0, 1000));
  EXPECT_EQ(error_of([&] { files::Reader reader(path); }),
            path + ": is not as it was written: it has 1000 bytes and had " +
                std::to_string(whole.size()) +
                ". Make it anew or take a copy; if it was changed on purpose, `chladni seal " +
                path + "` (or `squeal seal`) accepts it");
}

TEST(Seal, IsNotNeededWhereAFileBeginsAsHdf5Does)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5"), whole = sealed_bytes(path, 100);
  put_bytes(path, whole.substr(files::seal_size));
  EXPECT_EQ(files::Reader(path).vector("x").size(), 100);
  put_bytes(path, std::string(files::seal_size, ' ') +
                      whole.substr(files::seal_size));  // for libhdf5 as good
  EXPECT_TRUE(is_refused_by_the_seal(path));
}

TEST(SealFile, AcceptsAChangeAndMakesUpForAMissingOrDamagedSeal)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5"), whole = sealed_bytes(path, 100);
  std::string changed = whole;
  const double last = 1.0, other = 2.0;
  const std::string number(reinterpret_cast<const char*>(&last), sizeof last);
  changed.replace(changed.rfind(number), sizeof other, reinterpret_cast<const char*>(&other),
                  sizeof other);
  put_bytes(path, changed);
  EXPECT_TRUE(is_refused_by_the_seal(path));
  files::seal_file(path);
  EXPECT_EQ(files::Reader(path).vector("x")[99], 2.0);
  for (const std::string& before : {std::string(), std::string(files::seal_size, '?')}) {
    put_bytes(path, before + whole.substr(files::seal_size));
    files::seal_file(path);
    EXPECT_EQ(bytes_of(path), whole);
  }
}

TEST(SealFile, LeavesWhatLibhdf5CannotOpen)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5"), whole = sealed_bytes(path, 100);
  for (const std::string& bytes : {std::string("text"), std::string(), whole.substr(0, 2000)}) {
    put_bytes(path, bytes);
    EXPECT_TRUE(contains(error_of([&] { files::seal_file(path); }), path + ": cannot be sealed"));
    EXPECT_EQ(bytes_of(path), bytes);
  }
  EXPECT_TRUE(
      contains(error_of([&] { files::seal_file(folder.file("none.h5")); }), "no such file"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(SealFile, GivesAFileOfVersionTwoWithASealBesideItOneInside)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  const std::string golden = bytes_of(CHLADNI_SOURCE_DIR "/tests/data/version_1.reduced.h5");
  put_bytes(path, golden);
  put_bytes(path + ".seal", "Chladni seal 1\nbytes 28360\nxxh64 744ed126c2961351 of all bytes\n");
  EXPECT_EQ(read_reduced(path).K.rows(), read_reduced(path).M.rows());
  files::seal_file(path);
  EXPECT_EQ(without_places(bytes_of(path).substr(files::seal_size)), without_places(golden));
}

}  // namespace
}  // namespace chladni::mbs_export::hdf5
