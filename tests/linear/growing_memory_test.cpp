#include "linear/kernels/storage.hpp"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace chladni::linear {
namespace {

constexpr std::size_t numbers_of_a_MiB = (1 << 20) / sizeof(double);

[[maybe_unused]] double resident_MiB(const std::string& name)
{
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != name + ":") continue;
    double kB = 0.0;
    status >> kB;
    return kB / 1024.0;
  }
  return -1.0;
}

TEST(GrowingMemory, KeepsWhatIsThere)
{
  GrowingMemory memory;
  ASSERT_EQ(memory.grow(3), Lack::none);
  for (int i = 0; i < 3; ++i) memory.get()[i] = i + 1.0;
  ASSERT_EQ(memory.grow(8 * numbers_of_a_MiB), Lack::none);
  memory.get()[8 * numbers_of_a_MiB - 1] = 9.0;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(memory.get()[i], i + 1.0);
}

TEST(GrowingMemory, IsAFileWhereAFolderIsGiven)
{
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  GrowingMemory memory(folder.string());
  ASSERT_EQ(memory.grow(3), Lack::none);
  for (int i = 0; i < 3; ++i) memory.get()[i] = i + 1.0;
  ASSERT_EQ(memory.grow(8 * numbers_of_a_MiB), Lack::none);
  EXPECT_EQ(memory.get()[8 * numbers_of_a_MiB - 1], 0.0);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(memory.get()[i], i + 1.0);
  EXPECT_EQ(memory.grow(std::size_t(1) << 57), Lack::disk);
  EXPECT_EQ(memory.get()[0], 1.0);
}

TEST(GrowingMemory, SaysThatAFolderIsNotThere)
{
  EXPECT_EQ(GrowingMemory("/no/such/folder").grow(1), Lack::disk);
}

#ifndef CHLADNI_SANITIZED  // malloc is another one there, and ends the process

TEST(GrowingMemory, SaysThatThereIsNotSoMuch)
{
  GrowingMemory memory;
  ASSERT_EQ(memory.grow(1), Lack::none);
  memory.get()[0] = 5.0;
  EXPECT_EQ(memory.grow(std::size_t(1) << 57), Lack::memory);
  EXPECT_EQ(memory.get()[0], 5.0);
}

TEST(GrowingMemory, SaysThatAddressesAreLackingWhereTheFolderHasRoom)
{
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  const auto a_few_more = static_cast<rlim_t>(resident_MiB("VmSize") + 16.0) << 20;
  const rlimit low{.rlim_cur = a_few_more, .rlim_max = before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_AS, &low), 0);
  const Lack of_a_file =
      GrowingMemory(std::filesystem::temp_directory_path().string()).grow(64 * numbers_of_a_MiB);
  const Lack of_memory = GrowingMemory().grow(64 * numbers_of_a_MiB);
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
  EXPECT_EQ(of_a_file, Lack::addresses);
  EXPECT_EQ(of_memory, Lack::addresses);
  EXPECT_NE(told(of_a_file, "64 MiB", "ask for less", "/tmp").find("ulimit -v"), std::string::npos);
}

TEST(GrowingMemory, NeverStandsThereTwice)
{
  mallopt(M_MMAP_MAX, 0);  // what SuperLU_DIST does to its process
  GrowingMemory memory;
  ASSERT_EQ(memory.grow(100 * numbers_of_a_MiB), Lack::none);
  const void* behind = std::malloc(1000);  // so that a heap could not grow in place
  const double before = resident_MiB("VmRSS");
  for (std::size_t i = 0; i < 100 * numbers_of_a_MiB; i += 100) memory.get()[i] = 1.0;
  ASSERT_EQ(memory.grow(200 * numbers_of_a_MiB), Lack::none);
  const double most = resident_MiB("VmHWM") - before;
  std::free(const_cast<void*>(behind));
  mallopt(M_MMAP_MAX, 65536);
  EXPECT_GT(most, 99.0);
  EXPECT_LT(most, 120.0);
}

#endif

}  // namespace
}  // namespace chladni::linear
