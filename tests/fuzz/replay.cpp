#include "replay.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <vector>

#include "memory_file.hpp"

namespace chladni::fuzz {

int replay_corpus(const std::string& kind, Feed feed)
{
  int n = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(CHLADNI_SOURCE_DIR "/tests/fuzz/corpus/" + kind)) {
    SCOPED_TRACE(entry.path());
    const std::string bytes = bytes_of(entry.path());
    EXPECT_NO_THROW(feed({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
    ++n;
  }
  return n;
}

void feed_random_damage(Feed feed, int n_files)
{
  std::mt19937 random(1);
  for (int i = 0; i < n_files; ++i) {
    std::vector<std::uint8_t> bytes(3 * (1 + random() % 4));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    EXPECT_NO_THROW(feed(bytes)) << i;
  }
}

void feed_changed_bytes(Feed feed, const std::string& golden, int n_files)
{
  const std::string whole = bytes_of(golden);
  std::mt19937 random(1);
  for (int i = 0; i < n_files; ++i) {
    std::vector<std::uint8_t> bytes(whole.begin(), whole.end());
    for (int k = 0; k < 8; ++k) {
      std::uint8_t& byte = bytes[8 + random() % (bytes.size() - 8)];
      byte = static_cast<std::uint8_t>(byte ^ 1u << (random() % 8));
    }
    EXPECT_NO_THROW(feed(bytes)) << i;
  }
}

}  // namespace chladni::fuzz
