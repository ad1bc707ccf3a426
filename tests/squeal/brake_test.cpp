#include "squeal/models/brake.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "source_disc.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/models/rigid_disc.hpp"
#include "squeal/models/sliding_masses.hpp"
#include "squeal/study/study.hpp"
#include "squeal/study_options.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

constexpr double friction = 0.37, preload = 1234.0, stiffness = 5.6e6;

Oscillator mass_on_a_belt()
{
  return {.mass = 1.0,
          .k_x = 1.2e7,
          .k_y = 4e6,
          .k_xy = 1e6,
          .d_x = 5.0,
          .d_y = 5.0,
          .contact_stiffness = 7e6,
          .preload = 500.0,
          .radius = 0.13,
          .friction = {.kinetic = 0.3}};
}

/// The brake with the three values above, one after the other.
std::unique_ptr<Brake> changed(const Brake& brake)
{
  return brake.with(MapParameter::friction, friction)
      ->with(MapParameter::preload, preload)
      ->with(MapParameter::stiffness, stiffness);
}

TEST(Brake, WithOtherParametersIsTheOneThatIsMadeOfThem)
{
  const Disc disc = disc_of({kirchhoff_3()});
  SquealOptions options = reference_options();
  RigidDisc rigid = source_disc();
  Oscillator oscillator = mass_on_a_belt();
  const std::vector<std::unique_ptr<Brake>> found = [&] {
    std::vector<std::unique_ptr<Brake>> brakes;
    brakes.push_back(changed(FlexibleDisc(disc, options)));
    brakes.push_back(changed(RigidDiscBrake({.disc = rigid})));
    brakes.push_back(changed(SlidingBrake(oscillator)));
    return brakes;
  }();
  options.friction.kinetic = rigid.friction.kinetic = oscillator.friction.kinetic = friction;
  options.pads[0].preload = rigid.preload = oscillator.preload = preload;
  options.pads[0].stiffness = rigid.spring.linear = oscillator.contact_stiffness = stiffness;
  const FlexibleDisc flexible(disc, options);
  const RigidDiscBrake of_rigid({.disc = rigid});
  const SlidingBrake of_oscillator(oscillator);
  const Brake* const made[] = {&flexible, &of_rigid, &of_oscillator};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found[i]->state_matrix(20.0), made[i]->state_matrix(20.0)) << i;
    EXPECT_EQ(found[i]->rest_compression(), preload / stiffness) << i;
  }
}

TEST(Brake, HasTheStateMatrixOfItsMotion)
{
  // The same equations on two ways: complex steps or closed forms about rest, and the derivative of
  // the motion, which is smooth there.
  const FlexibleDisc flexible(disc_of({kirchhoff_3()}), reference_options());
  const RigidDiscBrake rigid({.disc = source_disc()});
  const SlidingBrake oscillator(mass_on_a_belt());
  for (const Brake* brake :
       {static_cast<const Brake*>(&flexible), static_cast<const Brake*>(&rigid),
        static_cast<const Brake*>(&oscillator)}) {
    const Eigen::MatrixXd A = brake->state_matrix(20.0);
    const auto motion = brake->motion(20.0);
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(motion->size());
    motion->rate_at(rest);
    EXPECT_LT((motion->jacobian(rest) - A).norm(), 1e-12 * A.norm());
  }
}

TEST(Analyses, HaveOneStepEach)
{
  std::vector<std::string_view> listed, done;
  for (const Analysis& analysis : analyses) listed.push_back(analysis.name);
  for (const AnalysisStep& step : analysis_steps()) {
    done.push_back(step.name);
    for (const std::string_view served : step.serves) EXPECT_TRUE(find_analysis(served)) << served;
  }
  std::ranges::sort(listed);
  std::ranges::sort(done);
  EXPECT_EQ(done, listed);
}

TEST(Analyses, OfModelsStandInTheirDocument)
{
  std::ifstream document(CHLADNI_SOURCE_DIR "/docs/explanation/rigid_disc.md");
  std::string row;
  while (std::getline(document, row) && !row.starts_with("| `analyses` |")) {
  }
  ASSERT_FALSE(row.empty());
  for (const Analysis& analysis : analyses) {
    const bool stands = row.find('"' + std::string(analysis.name) + '"') != std::string::npos;
    EXPECT_EQ(stands, !analysis.needs_body) << analysis.name;
  }
}

TEST(Analyses, ThatNeedABodyAreRefusedWithoutOne)
{
  const RigidDiscBrake brake({.disc = source_disc()});
  for (const Analysis& analysis : analyses) {
    if (!analysis.needs_body) continue;
    const StudyOptions study{.speeds = {.from = 1.0, .to = 2.0, .count = 2},
                             .analyses = {std::string(analysis.name)}};
    try {
      run(brake, study);
      ADD_FAILURE() << analysis.name;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("needs a disc with a modal body"), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace chladni::squeal
