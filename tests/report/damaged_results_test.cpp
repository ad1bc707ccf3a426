// What `./dev fuzz` does, a little of it in every run of the tests: whatever is done to the golden
// results, programs end in a value or a clear error.
#include <gtest/gtest.h>

#include "squeal/brake/radiation.hpp"
#include "squeal/results/squeal_results.hpp"
#include "tests/fuzz/fuzz_file.hpp"
#include "tests/fuzz/read_results.hpp"
#include "tests/fuzz/replay.hpp"

namespace chladni::fuzz {
namespace {

void feed_results(std::span<const std::uint8_t> bytes)
{
  feed(bytes, golden_results, read_results);
}

void feed_radiation(std::span<const std::uint8_t> bytes)
{
  feed(bytes, golden_radiation, read_radiation);
}

TEST(DamagedResults, AreReadWhereNothingIsDoneToThem)
{
  // Otherwise all that follows them would be refused, and nothing tested.
  EXPECT_NO_THROW(read_results(golden_results));
  EXPECT_NO_THROW(read_radiation(golden_radiation));
  bool read = false;
  feed({}, golden_results,
       [&](const std::string& path) { read = squeal::read_results(path).transient.has_value(); });
  EXPECT_TRUE(read);
}

TEST(DamagedResults, ThatOnceBrokeAReaderEndInAClearError)
{
  EXPECT_GT(replay_corpus("squeal", feed_results), 0);
  EXPECT_GT(replay_corpus("radiation", feed_radiation), 0);
}

TEST(DamagedResults, EndInAValueOrAClearError)
{
  feed_random_damage(feed_results, 120);
  feed_random_damage(feed_radiation, 60);
}

TEST(DamagedResults, WithChangedBytesEndInAValueOrAClearError)
{
  feed_changed_bytes(feed_results, golden_results, 60);
}

}  // namespace
}  // namespace chladni::fuzz
