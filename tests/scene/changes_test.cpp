#include "scene/scene_text.hpp"

#include <gtest/gtest.h>

namespace chladni::scene {
namespace {

using Changes = std::vector<std::string>;

constexpr const char* changed_disc = R"(
name = "disc"
title = "a disc"
[mesh]
generator = "annulus"
rings = [{ name = "track", nodes = 60 }, { name = "rim", nodes = 20 }]
[reduce]
modes = 10
[body]
fixed = ["hub"]
keep = { modes = 8 }
[squeal]
friction = 0.6
)";

/// The scene with one text in place of another.
std::string with(const std::string& from, const std::string& to)
{
  std::string text = changed_disc;
  return text.replace(text.find(from), from.size(), to);
}

TEST(ChangedKeys, AreThoseOfTheStep)
{
  const std::string friction = with("0.6", "0.5"), kept = with("modes = 8", "modes = 7");
  EXPECT_EQ(changed_keys(changed_disc, friction, Step::squeal),
            Changes{"squeal.friction = 0.5 (was 0.6)"});
  EXPECT_EQ(changed_keys(changed_disc, friction, Step::body), Changes{});
  EXPECT_EQ(changed_keys(changed_disc, friction, Step::reduction), Changes{});
  EXPECT_EQ(changed_keys(changed_disc, kept, Step::body), Changes{"body.keep.modes = 7 (was 8)"});
  EXPECT_EQ(changed_keys(changed_disc, kept, Step::reduction), Changes{});
}

TEST(ChangedKeys, NameTheElementOfAList)
{
  EXPECT_EQ(changed_keys(changed_disc, with("nodes = 20", "nodes = 24"), Step::reduction),
            Changes{"mesh.rings[2].nodes = 24 (was 20)"});
}

TEST(ChangedKeys, TellWhatCameAndWhatWent)
{
  EXPECT_EQ(changed_keys(changed_disc, with("modes = 10", "cutoff_Hz = 8e3"), Step::reduction),
            (Changes{"reduce.cutoff_Hz = 8000 (was not there)", "reduce.modes is gone (was 10)"}));
}

TEST(ChangedKeys, OfMicrophonesMatterToTheSoundAndNotToTheRadiation)
{
  const std::string sound = std::string(changed_disc) + "[sound]\nharmonics = 3\n";
  const std::string fewer = std::string(changed_disc) + "[sound]\nharmonics = 2\n";
  EXPECT_EQ(changed_keys(sound, fewer, Step::sound), Changes{"sound.harmonics = 2 (was 3)"});
  EXPECT_EQ(changed_keys(sound, fewer, Step::radiation), Changes{});
  EXPECT_EQ(changed_keys(sound, changed_disc, Step::sound), Changes{}) << "no table, no sound";
}

TEST(ChangedKeys, AreNoMatterOfSpelling)
{
  EXPECT_EQ(changed_keys(changed_disc, with("0.6", "6e-1  # dry"), Step::squeal), Changes{});
  EXPECT_EQ(changed_keys(changed_disc, with("modes = 10", "modes = 10.0"), Step::reduction),
            Changes{});
  EXPECT_EQ(changed_keys(changed_disc, with("a disc", "the disc"), Step::reduction), Changes{});
}

TEST(ChangedKeys, OfTheSupportsMatterToATolerance)
{
  const std::string other = with("\"hub\"", "\"rim\"");
  EXPECT_EQ(changed_keys(changed_disc, other, Step::reduction), Changes{});
  const std::string tolerance = with("modes = 10", "tolerance = 1e-3");
  std::string other_tolerance = tolerance;
  other_tolerance.replace(other_tolerance.find("\"hub\""), 5, "\"rim\"");
  EXPECT_EQ(changed_keys(tolerance, other_tolerance, Step::reduction),
            Changes{"body.fixed = \"rim\" (was \"hub\")"});
}

TEST(ChangedKeys, OfTheSupportsMatterToTheMixedInterface)
{
  const std::string mixed = with("modes = 10", "method = \"mixed-interface\"\nmodes = 10");
  std::string other = mixed;
  other.replace(other.find("\"hub\""), 5, "\"rim\"");
  EXPECT_EQ(changed_keys(mixed, other, Step::reduction),
            Changes{"body.fixed = \"rim\" (was \"hub\")"});
}

TEST(ChangedKeys, AreNotLookedForWhereThereIsNoScene)
{
  EXPECT_EQ(changed_keys("", changed_disc, Step::reduction), Changes{});
  EXPECT_EQ(changed_keys("no [ scene", changed_disc, Step::reduction), Changes{});
  EXPECT_EQ(
      changed_keys(changed_disc, "name = \"disc\"\n[squeal]\nfriction = 0.6\n", Step::reduction),
      Changes{});
}

}  // namespace
}  // namespace chladni::scene
