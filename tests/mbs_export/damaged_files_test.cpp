// What `./dev fuzz` found once, and a little of what it does, in every run of the tests: whatever
// is done to the golden files of version 1, reading and checking them ends in a value or a clear
// error.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <vector>

#include "mbs_export/check_body.hpp"
#include "mbs_export/files/body_file.hpp"
#include "mbs_export/files/reduced_file.hpp"
#include "tests/fuzz/fuzz_file.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace chladni::mbs_export {
namespace {

using Feed = void (*)(std::span<const std::uint8_t>);

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

/// The inputs that the fuzzers start from, those that once broke a reader among them.
int replay_corpus(const std::string& kind, Feed feed)
{
  int n = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(CHLADNI_SOURCE_DIR "/tests/fuzz/corpus/" + kind)) {
    SCOPED_TRACE(entry.path());
    const std::string bytes = fuzz::bytes_of(entry.path());
    EXPECT_NO_THROW(feed({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
    ++n;
  }
  return n;
}

void feed_random_damage(Feed feed, int n_files)
{
  std::mt19937 random(1);
  for (int i = 0; i < n_files; ++i) {
    std::vector<std::uint8_t> bytes(3 * (1 + random() % 4));  // one to four damages
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    EXPECT_NO_THROW(feed(bytes)) << i;
  }
}

TEST(DamagedFiles, ThatOnceBrokeAReaderEndInAClearError)
{
  EXPECT_GT(replay_corpus("body", feed_body), 0);
  EXPECT_GT(replay_corpus("reduced", feed_reduced), 0);
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
}

}  // namespace
}  // namespace chladni::mbs_export
