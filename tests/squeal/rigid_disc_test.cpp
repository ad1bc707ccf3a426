#include "squeal/models/rigid_disc.hpp"
#include "squeal/stability/eigenvalues.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "source_disc.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;
using test::source_disc;

const SpeedRange speeds{.from = pi, .to = 20.0 * pi, .count = 60};

/// SQUEAL reference values at q = (-0.005, 0.004), q' = (20, 35), 6 pi: a numpy program that shares
/// nothing with this one. 12 digits, rounding of a 3 x 3 solution.
struct Reference {
  ContactLaw law;
  double N_lower, q_ddot_1, q_ddot_2, moment, q_ddot_1_free, q_ddot_2_free, spin_rate_free;
};
const Reference rigid_references[] = {
    {ContactLaw::signed_force, -883.4703261619009, 592453.2064001065, -469604.26734382217,
     1450.8793639998594, 592477.7782081072, -469573.5524916761, -3071.5333341801065},
    {ContactLaw::bilateral, -888.1788224161496, 592447.6733410066, -469542.3929893004,
     1588.4670417065697, 592475.6848162989, -469507.37854014104, -3501.4997714942283},
    {ContactLaw::unilateral, 0.0, 591731.004932974, -469573.6050656989, 1518.5694675227705,
     591757.2689814349, -469540.77490663156, -3283.067340264656}};
const RigidMotion<double> large_rigid_motion{{-0.005, 0.004}, {20.0, 35.0}, 6.0 * pi};

TEST(RigidDisc, AcceleratesLikeTheReferenceForEachContactLawAndDrive)
{
  for (const Reference& reference : rigid_references) {
    SCOPED_TRACE(static_cast<int>(reference.law));
    const RigidDisc disc = source_disc(reference.law);
    const auto driven = accelerate(disc, large_rigid_motion, Drive::speed);
    EXPECT_NEAR(driven.q_ddot[0], reference.q_ddot_1, 1e-11 * 6e5);
    EXPECT_NEAR(driven.q_ddot[1], reference.q_ddot_2, 1e-11 * 6e5);
    EXPECT_NEAR(driven.moment, reference.moment, 1e-11 * 1.5e3);
    EXPECT_EQ(driven.spin_rate, 0.0);
    const auto free = accelerate(disc, large_rigid_motion, Drive::moment);
    EXPECT_NEAR(free.q_ddot[0], reference.q_ddot_1_free, 1e-11 * 6e5);
    EXPECT_NEAR(free.q_ddot[1], reference.q_ddot_2_free, 1e-11 * 6e5);
    EXPECT_NEAR(free.spin_rate, reference.spin_rate_free, 1e-11 * 6e5);
    EXPECT_DOUBLE_EQ(free.moment, 2.0 * 0.6 * 0.13 * 3000.0);
  }
}

TEST(RigidDisc, PressesThePadsLikeTheReference)
{
  for (const Reference& reference : rigid_references) {
    const auto a = accelerate(source_disc(reference.law), large_rigid_motion, Drive::speed);
    EXPECT_NEAR(a.upper.z, 0.010650210419556284, 1e-16);  // rounding of 1e-2
    EXPECT_NEAR(a.upper.z_dot, -2.599664993749955, 1e-13);
    EXPECT_NEAR(a.upper.slip_speed, 2.809564075877993, 1e-13);
    EXPECT_NEAR(a.lower.slip_speed, 2.1079031581937215, 1e-13);
    EXPECT_NEAR(a.upper.N, 6903.349848926033, 1e-8);
    EXPECT_NEAR(a.lower.N, reference.N_lower, 1e-8);
    // Vertical equilibrium of the massless pads.
    EXPECT_NEAR(a.upper.F[2], -a.upper.S, 1e-11 * a.upper.S);
    EXPECT_NEAR(a.lower.F[2], a.lower.S, 1e-11 * a.upper.S);
  }
}

TEST(RigidDisc, HasTheMatricesThatItsLinearisationGives)
{
  // Both drives, all laws, several speeds: rounding of the largest entry of each matrix.
  for (const Drive drive : {Drive::speed, Drive::moment})
    for (const Reference& reference : rigid_references)
      for (const double speed : {pi, 6.0 * pi, 20.0 * pi}) {
        const RigidDisc disc = source_disc(reference.law);
        const RigidMatrices closed = rigid_disc_matrices(disc, speed);
        const RigidMatrices numerical = linearised(disc, drive, speed);
        // The stiffness is a difference of moments of 1e3 N m and more, each rounded: 1e-12.
        EXPECT_LT((closed.C - numerical.C).cwiseAbs().maxCoeff(), 1e-13 * closed.C.norm());
        EXPECT_LT((closed.K - numerical.K).cwiseAbs().maxCoeff(), 1e-14 * closed.K.norm());
      }
}

TEST(RigidDisc, HasTheMatricesOfTheReference)
{
  // SQUEAL reference values at 6 pi; 16 digits.
  const RigidMatrices found = rigid_disc_matrices(source_disc(), 6.0 * pi);
  const RigidMatrices expected{
      .M = Eigen::Matrix2d{{0.16, 0.0}, {0.0, 0.16}},
      .C = Eigen::Matrix2d{{0.4159122551617495, 6.031857894892403}, {-6.039657894892403, 0.1}},
      .K = Eigen::Matrix2d{{19002860.0, 2.7692307692307536}, {-9827.999999999998, 18800081.6}}};
  EXPECT_LT((found.M - expected.M).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT((found.C - expected.C).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT((found.K - expected.K).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(RigidDisc, HasTheEigenvaluesOfTheReference)
{
  // SQUEAL reference values with 40 digits; rounding of 1e4 in double: 1e-11, margin of 10.
  const struct {
    double speed_by_pi;
    std::complex<double> lower, higher;
  } rows[] = {{1.0, {-0.4729529826449, 10839.60412518343}, {-3.4347768016379, 10898.22890054795}},
              {5.0, {-1.0468646874162, 10835.81185886162}, {-0.65718126944039, 10902.04349243849}},
              {10.4, {-1.4977089277022, 10825.16422789187}, {0.079718083059662, 10912.76670786779}},
              {20.0, {-1.7835817865162, 10799.81342502281}, {0.49272654730206, 10938.38259488658}}};
  for (const auto& row : rows) {
    const Eigen::Vector2cd lambda =
        eigenvalues(rigid_disc_matrices(source_disc(), row.speed_by_pi * pi));
    EXPECT_LT(std::abs(lambda[0] - row.lower), 1e-10) << row.speed_by_pi;
    EXPECT_LT(std::abs(lambda[1] - row.higher), 1e-10) << row.speed_by_pi;
  }
}

/// Critical speed over pi of the matrices after a change.
template <class Change>
double critical_of_rigid_disc(const Change& change)
{
  const StateMatrixAt matrices_at = [&](double speed) {
    RigidMatrices matrices = rigid_disc_matrices(source_disc(), speed);
    change(matrices);
    return first_order(matrices);
  };
  return critical_speed(stability_over_speed(matrices_at, speeds)).value().speed / pi;
}

TEST(RigidDisc, BecomesUnstableAtTheCriticalSpeedOfTheReference)
{
  // SQUEAL reference value with 40 digits. The growth rate, known to 1e-11, rises by 0.03 per unit
  // of speed: 3e-10 rad/s, 1e-11 relative.
  EXPECT_NEAR(critical_of_rigid_disc([](RigidMatrices&) {}), 9.478465586019481, 1e-9);
}

TEST(RigidDisc, HasNoCriticalSpeedWithoutFriction)
{
  RigidDisc disc = source_disc();
  disc.friction = {0.0};
  EXPECT_FALSE(critical_speed(stability_over_speed(
      [&](double speed) { return first_order(rigid_disc_matrices(disc, speed)); }, speeds)));
}

// What docs/explanation/rigid_disc.md says about equation (3.2) of the source and its 10.4 pi.
TEST(RigidDiscNote, NoReadingOfTheSourceGivesItsCriticalSpeed)
{
  const RigidDisc disc = source_disc();
  const double M_A = 2.0 * disc.friction.kinetic * disc.radius * disc.preload;
  const double printed = critical_of_rigid_disc([&](RigidMatrices& m) { m.C(0, 0) -= disc.d_t; });
  const double along_axis = critical_of_rigid_disc([&](RigidMatrices& m) {
    m.K(0, 1) -= M_A;
    m.K(1, 0) += M_A;
  });
  const double workless = critical_of_rigid_disc([&](RigidMatrices& m) { m.K(1, 0) += M_A; });
  // SQUEAL reference values; tolerance as above.
  EXPECT_NEAR(printed, 7.071993454795727, 1e-9);
  EXPECT_NEAR(along_axis, 10.679787364222378, 1e-9);
  EXPECT_NEAR(workless, 10.032172422448102, 1e-9);
}

/// Eigenvalues of the disc at one speed, of rising frequency.
struct PairAtSpeed {
  double speed_by_pi;
  std::complex<double> lower, higher;
};

/// SQUEAL reference values; rounding of 1e4 in two programs.
template <class Change>
void expect_eigenvalues(const std::vector<PairAtSpeed>& rows, const Change& change)
{
  for (const PairAtSpeed& row : rows) {
    SCOPED_TRACE(row.speed_by_pi);
    RigidMatrices matrices = rigid_disc_matrices(source_disc(), row.speed_by_pi * pi);
    change(matrices);
    const Eigen::Vector2cd lambda = eigenvalues(matrices);
    EXPECT_LT(std::abs(lambda[0] - row.lower), 1e-10);
    EXPECT_LT(std::abs(lambda[1] - row.higher), 1e-10);
  }
}

TEST(RigidDiscNote, EachReadingOfTheSourceHasTheEigenvaluesOfTheReference)
{
  const RigidDisc disc = source_disc();
  const double M_A = 2.0 * disc.friction.kinetic * disc.radius * disc.preload;
  const std::vector<PairAtSpeed> printed = {
      {1, {-0.47213669130680697, 10839.60323544992}, {-3.123093092976214, 10898.229888905245}},
      {5, {-1.0282319888436833, 10835.808598132915}, {-0.3633139680133207, 10902.046788647554}},
      {10.4, {-1.445734474083582, 10825.161110228413}, {0.3402436294414593, 10912.769852872081}},
      {20, {-1.6938621260048208, 10799.811750838693}, {0.7155068867907908, 10938.384292877718}},
  };
  const std::vector<PairAtSpeed> along_axis = {
      {1, {-0.458827141777307, 10839.597216132814}, {-3.448902642506907, 10898.235776285694}},
      {5, {-0.9829693996958548, 10835.806692825865}, {-0.7210765571606028, 10902.048625177928}},
      {10.4, {-1.39726310407797, 10825.1617765258}, {-0.020727740564494973, 10912.769125960149}},
      {20, {-1.661523617294139, 10799.812699246453}, {0.3706683780808442, 10938.383287430008}},
  };
  const std::vector<PairAtSpeed> workless = {
      {1, {-0.4657607867130286, 10839.60376040599}, {-3.4419689975696732, 10898.229265322507}},
      {5, {-1.0149528372192615, 10835.812032132626}, {-0.6890931196385572, 10902.043319172884}},
      {10.4, {-1.4475386472531353, 10825.165104639746}, {0.0295478026110675, 10912.765831136558}},
      {20, {-1.7225849414375467, 10799.814403097043}, {0.4317297022235334, 10938.381616849185}},
  };
  expect_eigenvalues(printed, [&](RigidMatrices& m) { m.C(0, 0) -= disc.d_t; });
  expect_eigenvalues(along_axis, [&](RigidMatrices& m) {
    m.K(0, 1) -= M_A;
    m.K(1, 0) += M_A;
  });
  expect_eigenvalues(workless, [&](RigidMatrices& m) { m.K(1, 0) += M_A; });
}

TEST(RigidDiscNote, EachParameterWouldHaveToChangeSoMuchForTheCriticalSpeedOfTheSource)
{
  // SQUEAL reference values: one parameter alone, the others those of the source.
  const struct {
    const char* name;
    double* (*of)(RigidDisc&);
    std::vector<double> values;
  } rows[] = {
      {"kt", [](RigidDisc& disc) { return &disc.k_t; }, {26862127.573958557}},
      {"dt", [](RigidDisc& disc) { return &disc.d_t; }, {0.12545266548372383}},
      {"k", [](RigidDisc& disc) { return &disc.spring.linear; }, {4916809.38444717}},
      {"d", [](RigidDisc& disc) { return &disc.damping; }, {5.904948247868073}},
      {"N0", [](RigidDisc& disc) { return &disc.preload; }, {4404.455374504033}},
      {"mu", [](RigidDisc& disc) { return &disc.friction.kinetic; }, {0.5425829418942868}},
      {"r0",
       [](RigidDisc& disc) { return &disc.radius; },
       {0.06770517735647429, 0.1406279837944478}},
      {"h", [](RigidDisc& disc) { return &disc.thickness; }, {0.01730679540254759}},
      {"Th", [](RigidDisc& disc) { return &disc.Theta; }, {0.11245933842320206}},
      {"Ph", [](RigidDisc& disc) { return &disc.Phi; }, {0.2817843209408045}},
  };
  for (const auto& row : rows)
    for (const double value : row.values) {
      SCOPED_TRACE(testing::Message() << row.name << " = " << value);
      RigidDisc disc = source_disc();
      *row.of(disc) = value;
      const Eigen::Vector2cd lambda = eigenvalues(rigid_disc_matrices(disc, 10.4 * pi));
      EXPECT_NEAR(lambda.real().maxCoeff(), 0.0, 1e-9);
    }
}

TEST(RigidDiscNote, TheDamperThatThePrintedMatrixLacksIsInTheLinearisation)
{
  const RigidDisc disc = source_disc();
  RigidDisc undamped = disc;
  undamped.d_t = 0.0;
  const Eigen::Matrix2d difference =
      linearised(disc, Drive::speed, 6.0 * pi).C - linearised(undamped, Drive::speed, 6.0 * pi).C;
  EXPECT_LT((difference - disc.d_t * Eigen::Matrix2d::Identity()).norm(), 1e-14);
}

}  // namespace
}  // namespace chladni::squeal
