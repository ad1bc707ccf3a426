#include "linear/machine_memory.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace chladni::linear {
namespace {

namespace fs = std::filesystem;

/// A folder with the files that the kernel shows of control groups.
class ControlGroupFiles : public testing::Test {
 protected:
  ControlGroupFiles() { fs::create_directories(folder_); }
  ~ControlGroupFiles() override { fs::remove_all(folder_); }

  void write(const fs::path& name, const std::string& text) const
  {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  double free_MiB() const
  {
    return free_MiB_of_control_group({.groups = folder_ / "self", .root = folder_ / "root"});
  }

 private:
  fs::path folder_ = fs::temp_directory_path() / ("chladni_groups_" + std::to_string(getpid()));
};

TEST_F(ControlGroupFiles, WithoutALimitLetEverythingBeTaken)
{
  EXPECT_EQ(free_MiB(), std::numeric_limits<double>::infinity());
  write("self", "0::/user/me\n");
  write("root/user/me/memory.max", "max\n");
  write("root/user/me/memory.current", "1048576\n");
  EXPECT_EQ(free_MiB(), std::numeric_limits<double>::infinity());
}

TEST_F(ControlGroupFiles, OfVersionTwoCountThoseAboveAndNoCachedFiles)
{
  write("self", "0::/job/step\n");
  write("root/job/step/memory.max", "8388608\n");
  write("root/job/step/memory.current", "3145728\n");
  write("root/job/step/memory.stat", "anon 1048576\nactive_file 1048576\ninactive_file 1048576\n");
  EXPECT_DOUBLE_EQ(free_MiB(), 7.0);
  write("root/job/memory.max", "4194304\n");
  write("root/job/memory.current", "3145728\n");
  EXPECT_DOUBLE_EQ(free_MiB(), 1.0);
}

TEST_F(ControlGroupFiles, OfVersionOneAreUnderMemory)
{
  write("self", "5:devices:/\n4:memory:/slurm/job\n0::/\n");
  write("root/memory/slurm/job/memory.limit_in_bytes", "8388608\n");
  write("root/memory/slurm/job/memory.usage_in_bytes", "3145728\n");
  write("root/memory/slurm/job/memory.stat", "total_active_file 0\ntotal_inactive_file 1048576\n");
  EXPECT_DOUBLE_EQ(free_MiB(), 6.0);
}

TEST_F(ControlGroupFiles, OfAContainerAreThoseOfTheRoot)
{
  write("self", "0::/machine/container\n");  // a path that is not there
  write("root/memory.max", "2097152\n");
  write("root/memory.current", "4194304\n");
  EXPECT_DOUBLE_EQ(free_MiB(), 0.0);
}

TEST(FreeMemory, IsThatOfThisMachine)
{
  EXPECT_GT(free_MiB(), 0.0);
  EXPECT_LT(free_MiB(), 1e9);
}

}  // namespace
}  // namespace chladni::linear
