#pragma once

#include <cstdint>
#include <span>
#include <string>

/// A little of what `./dev fuzz` does, for every run of the tests.
namespace chladni::fuzz {

/// A reader that is fed what a fuzzer would feed it.
using Feed = void (*)(std::span<const std::uint8_t> bytes);

/// Feeds the inputs that the fuzzers start from, those that once broke a reader among them. Each
/// exception fails the running test.
/// @param kind  a folder of tests/fuzz/corpus
/// @return how many there are
int replay_corpus(const std::string& kind, Feed feed);

/// Feeds one to four damages (see damage.hpp), n_files times, always the same ones.
void feed_random_damage(Feed feed, int n_files);

/// Feeds a file with a few of its bytes changed, n_files times, always the same ones: libhdf5 meets
/// what it says of itself.
void feed_changed_bytes(Feed feed, const std::string& golden, int n_files);

}  // namespace chladni::fuzz
