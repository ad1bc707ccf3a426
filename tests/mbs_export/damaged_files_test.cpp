// What `./dev fuzz` found once, and a little of what it does, in every run of the tests: whatever
// is done to the golden files of version 1, reading and checking them ends in a value or a clear
// error.
#include <gtest/gtest.h>

#include "common/error.hpp"
#include "mbs_export/check_body.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mbs_export/measured/measured_functions.hpp"
#include "mbs_export/measured/measured_modes.hpp"
#include "tests/fuzz/fuzz_file.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/replay.hpp"

namespace chladni::mbs_export {
namespace {

using fuzz::feed_random_damage, fuzz::replay_corpus;

void feed_body(std::span<const std::uint8_t> bytes)
{
  fuzz::feed(bytes, CHLADNI_SOURCE_DIR "/tests/data/version_1.body.h5",
             [](const std::string& path) { check_body(read_body(path)); });
}

void feed_reduced(std::span<const std::uint8_t> bytes)
{
  fuzz::feed(bytes, CHLADNI_SOURCE_DIR "/tests/data/version_1.reduced.h5",
             [](const std::string& path) { check_reduced(read_reduced(path)); });
}

void feed_measured(std::span<const std::uint8_t> bytes)
{
  const fuzz::MemoryFile file(bytes);
  try {
    read_measured_modes(file.path(), 1.0);
  } catch (const Error&) {
  }
  try {
    within(read_measured_functions(file.path(), 1.0), 10.0, 1000.0);
  } catch (const Error&) {
  }
}

TEST(DamagedFiles, ThatOnceBrokeAReaderEndInAClearError)
{
  EXPECT_GT(replay_corpus("body", feed_body), 0);
  EXPECT_GT(replay_corpus("reduced", feed_reduced), 0);
  EXPECT_GT(replay_corpus("measured", feed_measured), 0);
  EXPECT_GT(replay_corpus("slow_reduced", feed_reduced), 0);  // as long as trials may take
}

TEST(DamagedFiles, AreReadWhereNothingIsDoneToThem)
{
  // Otherwise all that follows them would be refused, and nothing tested.
  bool read = false;
  fuzz::feed({}, CHLADNI_SOURCE_DIR "/tests/data/version_1.reduced.h5",
             [&](const std::string& path) { read = read_reduced(path).n_masters() > 0; });
  EXPECT_TRUE(read);
}

TEST(DamagedFiles, EndInAValueOrAClearError)
{
  feed_random_damage(feed_body, 200);
  feed_random_damage(feed_reduced, 200);
  for (const char* const name : {"modes.unv", "functions.unv", "functions_58b.unv"}) {
    fuzz::feed_changed_bytes(
        feed_measured, CHLADNI_SOURCE_DIR "/tests/fuzz/corpus/measured/" + std::string(name), 500);
  }
}

}  // namespace
}  // namespace chladni::mbs_export
