#include "linear/kernels/growing_memory.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

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
  ASSERT_TRUE(memory.grow(3));
  for (int i = 0; i < 3; ++i) memory.get()[i] = i + 1.0;
  ASSERT_TRUE(memory.grow(8 * numbers_of_a_MiB));
  memory.get()[8 * numbers_of_a_MiB - 1] = 9.0;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(memory.get()[i], i + 1.0);
}

TEST(GrowingMemory, IsAFileWhereAFolderIsGiven)
{
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  GrowingMemory memory(folder.string());
  ASSERT_TRUE(memory.grow(3));
  for (int i = 0; i < 3; ++i) memory.get()[i] = i + 1.0;
  ASSERT_TRUE(memory.grow(8 * numbers_of_a_MiB));
  EXPECT_EQ(memory.get()[8 * numbers_of_a_MiB - 1], 0.0);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(memory.get()[i], i + 1.0);
  EXPECT_FALSE(memory.grow(std::size_t(1) << 57));
  EXPECT_EQ(memory.get()[0], 1.0);
}

TEST(GrowingMemory, SaysThatAFolderIsNotThere)
{
  EXPECT_FALSE(GrowingMemory("/no/such/folder").grow(1));
}

#ifndef CHLADNI_SANITIZED  // malloc is another one there, and ends the process

TEST(GrowingMemory, SaysThatThereIsNotSoMuch)
{
  GrowingMemory memory;
  ASSERT_TRUE(memory.grow(1));
  memory.get()[0] = 5.0;
  EXPECT_FALSE(memory.grow(std::size_t(1) << 57));
  EXPECT_EQ(memory.get()[0], 5.0);
}

TEST(GrowingMemory, NeverStandsThereTwice)
{
  mallopt(M_MMAP_MAX, 0);  // what SuperLU_DIST does to its process
  GrowingMemory memory;
  ASSERT_TRUE(memory.grow(100 * numbers_of_a_MiB));
  const void* behind = std::malloc(1000);  // so that a heap could not grow in place
  const double before = resident_MiB("VmRSS");
  for (std::size_t i = 0; i < 100 * numbers_of_a_MiB; i += 100) memory.get()[i] = 1.0;
  ASSERT_TRUE(memory.grow(200 * numbers_of_a_MiB));
  const double most = resident_MiB("VmHWM") - before;
  std::free(const_cast<void*>(behind));
  mallopt(M_MMAP_MAX, 65536);
  EXPECT_GT(most, 99.0);
  EXPECT_LT(most, 120.0);
}

#endif

}  // namespace
}  // namespace chladni::linear
