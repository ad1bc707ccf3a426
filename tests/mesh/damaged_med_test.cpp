// What `./dev fuzz` found once of MED files, and a little of what it does, in every run of the
// tests.
#include <gtest/gtest.h>

#include "common/error.hpp"
#include "mesh/exchange/med.hpp"
#include "tests/fuzz/damage.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/replay.hpp"

namespace chladni::mesh {
namespace {

const std::string golden = CHLADNI_SOURCE_DIR "/tests/data/three_by_two.med";

/// What reading says after the damage that the bytes tell; nothing where it is read.
std::string said_of(std::span<const std::uint8_t> bytes)
{
  const std::string whole = fuzz::bytes_of(golden);
  const fuzz::MemoryFile file({reinterpret_cast<const std::uint8_t*>(whole.data()), whole.size()});
  fuzz::damage(file.path(), bytes);
  try {
    med_mesh(fuzz::bytes_of(file.path()));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void feed_med(std::span<const std::uint8_t> bytes)
{
  said_of(bytes);
}

TEST(DamagedMed, IsReadWhereNothingIsDoneToIt)
{
  EXPECT_EQ(said_of({}), "");
}

TEST(DamagedMed, ThatOnceBrokeTheReaderEndsInAClearError)
{
  EXPECT_GT(fuzz::replay_corpus("med", feed_med), 0);
  const std::string bytes =
      fuzz::bytes_of(CHLADNI_SOURCE_DIR "/tests/fuzz/corpus/med/more_values_than_stored");
  const std::string said =
      said_of({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  EXPECT_NE(said.find("claims more values than the file can hold"), std::string::npos) << said;
}

TEST(DamagedMed, EndsInAMeshOrAClearError)
{
  fuzz::feed_random_damage(feed_med, 300);
}

}  // namespace
}  // namespace chladni::mesh
