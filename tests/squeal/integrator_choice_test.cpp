#include <gtest/gtest.h>

#include "common/error.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/transient/integrator_choice.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

TEST(IntegratorChoice, FollowsTheDiscAndTheErrorAllowed)
{
  const auto chosen = [](const std::vector<PlatePair>& pairs, double growth_error,
                         double pad_damping) {
    const Disc disc = disc_of(pairs);
    SquealOptions options = reference_options();
    options.pads[0].damping = pad_damping;
    const TransientCase run{.speed = 6.0 * pi,
                            .duration = 1.0,
                            .initial_pad_displacement = 1e-6,
                            .growth_error = growth_error};
    return choose_integrator(disc, find_inertial_disc(disc), options, run);
  };
  PlatePair split = kirchhoff_3();
  split.split = 0.05;
  EXPECT_EQ(chosen({kirchhoff_3()}, 1e-3, 0.0).kind, IntegratorKind::exponential);
  EXPECT_EQ(chosen({split}, 1e-3, 0.0).kind, IntegratorKind::splitting);
  EXPECT_EQ(chosen({split}, 1e-7, 0.0).kind, IntegratorKind::dormand_prince);
  EXPECT_EQ(chosen({kirchhoff_3()}, 1e-3, 1e6).kind, IntegratorKind::generalised_alpha);
  EXPECT_FALSE(chosen({split}, 1e-3, 0.0).reason.empty());
}

TEST(IntegratorChoice, MeasuresTheErrorThatASplittingStepAdds)
{
  // Growth in a simulation with 12 steps for a period is as far from the exact one as the
  // eigenvalues of the step say. The fit of the envelope adds less than 1e-4.
  const Disc disc = disc_of({kirchhoff_3()});
  const InertialDisc inertial = inertial_disc(disc);
  const double speed = 6.0 * pi;
  const auto predicted = [&](int steps) {
    return growth_error_of(IntegratorKind::splitting, inertial, reference_options(), speed, steps);
  };
  const Transient run =
      transient(FlexibleDisc(disc, reference_options()), {.speed = speed,
                                                          .duration = 2.0,
                                                          .initial_pad_displacement = 1e-8,
                                                          .steps_per_period = 12,
                                                          .integrator = IntegratorKind::splitting});
  const double exact =
      least_stable_eigenvalue(state_matrix(inertial, reference_options(), speed)).real();
  EXPECT_NEAR(std::abs(*run.growth_rate - exact), predicted(12), 1e-4);
  EXPECT_GT(predicted(12), 5e-4);
  EXPECT_NEAR(predicted(12) / predicted(24), 4.0, 0.3);
}

TEST(IntegratorChoice, RefusesTheExponentialIntegratorForADiscThatIsNotAxisymmetric)
{
  PlatePair split = kirchhoff_3();
  split.split = 0.05;
  EXPECT_THROW(transient(FlexibleDisc(disc_of({split}), reference_options()),
                         {.speed = 6.0 * pi,
                          .duration = 0.1,
                          .initial_pad_displacement = 1e-6,
                          .integrator = IntegratorKind::exponential}),
               Error);
}

}  // namespace
}  // namespace chladni::squeal
