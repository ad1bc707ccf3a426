// Studies of which a part cannot be done: what is known before, and what stays.
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "sound/radiation.hpp"
#include "sound/study.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "tests/references/sound/thesis_disc.hpp"

namespace chladni::sound {
namespace {

using std::numbers::pi;

/// The disc of the thesis between its pads, with coarse air in space where it has holes.
struct Case {
  mbs_export::ModalBody body = testing::thesis_body();
  squeal::SquealOptions brake = {};
  SoundOptions options = {.lines = {{.from = {testing::hub_radius, 0.0},
                                     .to = {testing::disc_radius, 0.0},
                                     .thickness = testing::disc_thickness}},
                          .microphones = {{"above", {0.5, 0.0, 0.5}}},
                          .harmonics = 1};
  squeal::SquealResults squeal_results = {};

  explicit Case(squeal::ContactLaw contact = squeal::ContactLaw::bilateral)
  {
    brake.ring = "track";
    brake.thickness = testing::disc_thickness;
    brake.study.speeds = {.from = pi, .to = 20.0 * pi, .count = 30};
    brake.friction.kinetic = 0.6;
    brake.contact = contact;
    brake.pads = {{.angle = 0.0, .stiffness = 6e6, .damping = 0.0, .preload = 2000.0}};
    squeal_results.limit_cycle_direct = squeal::limit_cycle_direct(
        squeal::FlexibleDisc(squeal::disc_on_ring(body, "track", {}), brake), 6.0 * pi);
  }
  Setting setting() const { return {body, brake, options}; }
};

squeal::Radiation uneven()
{
  const Eigen::Vector2d two = Eigen::Vector2d::Ones();
  return {.mode_numbers = {1, 2},
          .omega = two,
          .at = two,
          .damping = Eigen::Vector2d(3.0, 4.0),
          .added_mass = Eigen::Vector2d(0.1, 0.3)};
}

/// What is left of a difference of 1 between the pair with three nodal diameters.
double difference_with(const std::vector<Holes>& holes)
{
  const Case disc;
  const Outline outline = thick_body(disc.options.lines, Hub::closed, holes).outline;
  const auto even =
      even_over_pairs(uneven(), squeal::disc_on_ring(disc.body, "track", {}), outline);
  EXPECT_NEAR(even.damping.sum(), 7.0, 1e-12);
  return even.damping[1] - even.damping[0];
}

TEST(EvenRadiation, IsThatOfPairsWhichTheOutlineDoesNotTellApart)
{
  EXPECT_EQ(difference_with({}), 0.0);
  EXPECT_EQ(difference_with({{0.13, 0.01, 7}}), 0.0);
  EXPECT_EQ(difference_with({{0.13, 0.01, 8}, {0.1, 0.01, 4}}), 0.0);
  EXPECT_EQ(difference_with({{0.13, 0.01, 6}}), 1.0) << "holes at the nodes of one of the two";
  EXPECT_EQ(difference_with({{0.13, 0.01, 9}, {0.1, 0.01, 3}}), 1.0);
}

TEST(HinderedStudy, LeavesTheFeedbackOutWhereRadiationIsNotAxisymmetric)
{
  Case disc;
  disc.options.holes = {{0.13, 0.016, 6}};
  disc.options.air.element_size = 0.048;
  disc.options.air.edge_size = 0.012;
  const SoundResults results = radiation_study(disc.setting(), 6.0 * pi);
  EXPECT_FALSE(results.feedback);
  EXPECT_GT(results.radiation.damping.minCoeff(), 0.0);
  ASSERT_EQ(results.notes.size(), 1U);
  EXPECT_NE(results.notes[0].find("what the sound does to the squeal"), std::string::npos);
  EXPECT_NE(results.notes[0].find("changes around the circumference"), std::string::npos);
}

TEST(HinderedStudy, FindsAirTooCoarseForAHarmonicBeforeAnythingIsSolved)
{
  Case disc(squeal::ContactLaw::unilateral);  // which has harmonics
  disc.options.air = {.order = 2, .element_size = 0.03};
  disc.options.harmonics = 3;
  bool solved = false;
  const StudyListener listener{.found = [&](const SoundResults&) { solved = true; }};
  EXPECT_THROW(sound_study(disc.setting(), disc.squeal_results, listener), Error);
  EXPECT_FALSE(solved);
  disc.options.harmonics = 1;
  EXPECT_NO_THROW(sound_study(disc.setting(), disc.squeal_results, listener));
  EXPECT_TRUE(solved);
}

TEST(HinderedStudy, HandsOverTheRadiationBeforeTheRestEnds)
{
  const Case disc;
  std::vector<SoundResults> kept;
  const StudyListener interrupted{
      .progress =
          [](const std::string& step, double) {
            if (step == "feedback") throw Error("interrupted");
          },
      .found = [&](const SoundResults& results) { kept.push_back(results); }};
  EXPECT_THROW(sound_study(disc.setting(), disc.squeal_results, interrupted), Error);
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].radiation.mode_numbers, (std::vector<int>{1, 2}));
  EXPECT_TRUE(kept[0].tones.empty());
}

}  // namespace
}  // namespace chladni::sound
