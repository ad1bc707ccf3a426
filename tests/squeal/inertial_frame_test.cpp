#include "squeal/brake/inertial_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <utility>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/disc.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

std::string complaint(const Disc& disc)
{
  try {
    inertial_disc(disc);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Eigenvectors of a degenerate pair: turned by 0.4 rad, the second one reversed.
PlatePair turned_pair()
{
  PlatePair pair = kirchhoff_3();
  pair.turn = 0.4;
  pair.sign = -1.0;
  return pair;
}

TEST(InertialDisc, FindsAmplitudesOfAPairInAnyOrientation)
{
  const double root = std::sqrt(kirchhoff_3().mass);
  for (const double sign : {1.0, -1.0}) {
    PlatePair pair = turned_pair();
    pair.sign = sign;
    const InertialDisc disc = inertial_disc(disc_of({pair}));
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(disc.rings[0].U[i] * root, kirchhoff_3().U, 1e-13);
      EXPECT_NEAR(disc.rings[0].U_r[i] * root, kirchhoff_3().U_r, 1e-12);
      EXPECT_NEAR(disc.rings[0].U_t[i] * root, kirchhoff_3().U_t, 1e-12);
    }
    EXPECT_LT(disc.largest_impurity, 1e-7);  // square root of the rounding of squares
    EXPECT_LT((disc.R.transpose() * disc.R - Eigen::Matrix2d::Identity()).norm(), 1e-14);
  }
}

TEST(InertialDisc, SeesWhatTheRotatingDiscSees)
{
  // w(phi, t) = sum W_i(phi - Omega t) q_i = sum W_i(phi) a_i with a = exp(-Omega t D) R' q, for
  // pairs in any orientation, neighbours or not, and a mode without nodal diameters.
  PlatePair umbrella{.n = 0, .f_Hz = 657.0, .mass = 4.2, .U = 0.7, .U_r = 8.5, .U_t = 0.0};
  const Disc disc = disc_of({umbrella, turned_pair(), kirchhoff_2(), kirchhoff_4()});
  const InertialDisc inertial = inertial_disc(disc);
  const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(7, -1.0, 2.0);
  const double phi = 0.8, angle = 2.1;
  const Eigen::VectorXd a = turned(inertial, inertial.R.transpose() * q, angle);
  const Shapes body = shapes_at(disc, phi - angle), fixed = shapes_at(inertial, phi);
  EXPECT_NEAR(body.W.dot(q), fixed.W.dot(a), 1e-12);
  EXPECT_NEAR(body.W_r.dot(q), fixed.W_r.dot(a), 1e-11);
  EXPECT_NEAR(body.W_t.dot(q), fixed.W_t.dot(a), 1e-11);
}

TEST(InertialDisc, HasTheCircumferentialDerivativeOfItsShapes)
{
  const InertialDisc disc = inertial_disc(disc_of({kirchhoff_2(), turned_pair()}));
  const double phi = 0.6, step = 1e-4;
  const Eigen::VectorXd difference =
      (shapes_at(disc, phi + step).W - shapes_at(disc, phi - step).W) / (2 * step);
  // Central difference: error n^3 step^2 / 6.
  EXPECT_LT((difference - disc.D.transpose() * shapes_at(disc, phi).W).norm(), 1e-6);
}

TEST(RotationGenerator, IsThatOfThePairWhereVanesAddAHighHarmonicThatTurnsTheOtherWay)
{
  // cos and sin of phi with a part b of those of 35 phi, of which the sine has the other sign. Each
  // harmonic d counts by S c / d = i c: S = (1 - b^2 / 35) / (1 + b^2 / 35^2).
  for (const double b : {0.0, 0.2, 0.5}) {
    RingHarmonics harmonics{std::vector<Eigen::MatrixXcd>(37, Eigen::MatrixXcd::Zero(2, 1))};
    const std::complex<double> i(0.0, 1.0);
    harmonics.c[1].col(0) << 1.0, -i;
    harmonics.c[35].col(0) << b, b * i;
    const Eigen::MatrixXd S = rotation_generator(harmonics, Eigen::Vector2d(100.0, 100.0));
    const double expected = (1.0 - b * b / 35.0) / (1.0 + b * b / 1225.0);
    EXPECT_NEAR(std::abs(S(0, 1)), expected, 1e-12) << b;
    EXPECT_EQ(S(0, 1), -S(1, 0));
    const std::vector<HarmonicSpace> spaces = harmonic_spaces(S);
    ASSERT_EQ(spaces.size(), 1u);
    EXPECT_EQ(spaces[0].d, 1) << b;
  }
}

TEST(InertialDisc, AveragesTheFrequenciesOfAPairAndTellsTheirSplit)
{
  PlatePair pair = kirchhoff_3();
  pair.split = 2e-4;
  const InertialDisc disc = inertial_disc(disc_of({pair}));
  EXPECT_NEAR(disc.omega[0], 2 * pi * pair.f_Hz * (1 + 1e-4), 1e-9);
  EXPECT_EQ(disc.omega[0], disc.omega[1]);
  EXPECT_NEAR(disc.largest_split, 2e-4, 1e-7);
}

TEST(InertialDisc, ToleratesTheImpuritiesOfAMesh)
{
  auto body = analytic_body({kirchhoff_3()});
  srand(1);
  body.rings[0].W += 1e-3 * Eigen::MatrixXd::Random(60, 2);
  const InertialDisc disc = inertial_disc(disc_on_ring(body, "track", {}));
  EXPECT_GT(disc.largest_impurity, 1e-4);
  EXPECT_NEAR(disc.rings[0].U[0] * std::sqrt(kirchhoff_3().mass), kirchhoff_3().U, 1e-3);
}

TEST(InertialDisc, SaysByHowMuchADiscIsNotAxisymmetric)
{
  auto body = analytic_body({kirchhoff_3()});
  body.rings[0].W.col(0) *= 1.3;  // about 0.06 of the motion of the pair
  EXPECT_NE(complaint(disc_on_ring(body, "track", {})).find("differ from pure harmonics by 0.0"),
            std::string::npos);
  PlatePair split = kirchhoff_3();
  split.split = 0.02;
  EXPECT_NE(complaint(disc_of({split})).find("frequencies of a pair differ by 0.02"),
            std::string::npos);
  EXPECT_NE(complaint(disc_of({split})).find("need an axisymmetric disc and both modes of"),
            std::string::npos);
  // Who looks for its limit cycle is told what there is instead.
  try {
    FlexibleDisc(disc_of({split}), {}).inertial();
    FAIL() << "it has no inertial frame";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("ask for \"transient\" with \"motion-statistics\""),
              std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(find_inertial_disc(disc_of({split})));
}

TEST(InertialDisc, TakesShapesAsPureThatAreAsUncertainAsTheyAreImpure)
{
  auto body = analytic_body({kirchhoff_3()});
  body.rings[0].W.col(0) *= 1.3;
  const auto with_errors_of = [&](double error) {
    body.certificate = {.fixed = body.fixed,
                        .frequencies = body.omega,
                        .estimates = Eigen::Vector2d::Constant(error)};
    return disc_on_ring(body, "track", {});
  };
  // The root of twice the error: 0.1 and 0.032.
  const InertialDisc disc = inertial_disc(with_errors_of(5e-3));
  EXPECT_NEAR(disc.explained_impurity, 0.038, 1e-3);
  EXPECT_EQ(disc.largest_impurity, 0.0);
  EXPECT_NE(complaint(with_errors_of(5e-4)).find("differ from pure harmonics by 0.0"),
            std::string::npos);
}

TEST(InertialDisc, NeedsBothModesOfAPair)
{
  const auto body = analytic_body({kirchhoff_2(), kirchhoff_3()});
  const Disc disc =
      disc_on_ring(body, "track", {.nodal_diameters = std::nullopt, .list = std::vector{1, 2, 3}});
  EXPECT_NE(complaint(disc).find("mode 3 (1749.7 Hz) has 3 nodal diameters, but no partner"),
            std::string::npos);
}

TEST(InertialDisc, TellsWhatIsJustBeyondALimitWithDigitsThatShowIt)
{
  PlatePair split = kirchhoff_3();
  split.split = 0.010001;  // of the lower frequency; 0.00995 of the mean
  for (; complaint(disc_of({split})).empty(); split.split += 1e-6) ASSERT_LT(split.split, 0.011);
  const std::string text = complaint(disc_of({split}));
  EXPECT_NE(text.find("differ by 0.01000"), std::string::npos) << text;
  EXPECT_EQ(text.find("differ by 0.01 "), std::string::npos) << text;
}

TEST(InertialDisc, LetsModesBeyondTheRangeFollowWhereTheirPartnersAreMissing)
{
  PlatePair far = kirchhoff_4();
  far.f_Hz = 9e3;
  mbs_export::ModalBody body = analytic_body({kirchhoff_2(), kirchhoff_3(), far});
  for (Eigen::MatrixXd* shapes : {&body.rings[0].W, &body.rings[0].W_r, &body.rings[0].W_t})
    shapes->col(5).setZero();
  body.certificate = {.fixed = body.fixed, .frequencies = body.omega.head(4)};
  const Disc disc = disc_on_ring(body, "track", {});
  EXPECT_EQ(disc.mode_numbers, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(disc.alone, (std::vector<int>{5}));
  EXPECT_EQ(disc.compliance.mode_numbers, (std::vector<int>{5}));
  EXPECT_NE(notes_of(disc).at(1).find("lack the partner"), std::string::npos) << notes_of(disc)[1];
  EXPECT_TRUE(find_inertial_disc(disc));
  // Within the certified frequencies this is no disc.
  body.certificate.frequencies = body.omega.head(5);
  EXPECT_NE(complaint(disc_on_ring(body, "track", {})).find("no partner"), std::string::npos);
}

TEST(InertialDisc, LetsAllThatAReductionHasBeyondItsRangeFollowInADiscThatIsNotAxisymmetric)
{
  // Equations over the rotation grow with the square of the modes: what is no mode of the disc
  // stays out of them. A body with modes that were chosen keeps them.
  PlatePair split = kirchhoff_3(), far = kirchhoff_4();
  split.split = 0.02;
  far.f_Hz = 9e3;
  mbs_export::ModalBody body = analytic_body({kirchhoff_2(), split, far});
  for (Eigen::MatrixXd* shapes : {&body.rings[0].W, &body.rings[0].W_r, &body.rings[0].W_t})
    shapes->col(5).setZero();
  body.certificate = {.fixed = body.fixed, .frequencies = body.omega.head(4)};
  EXPECT_EQ(disc_on_ring(body, "track", {}).mode_numbers, (std::vector<int>{1, 2, 3, 4, 5}));
  body.preparation.n_constrained_modes = 6;
  const Disc disc = disc_on_ring(body, "track", {});
  EXPECT_EQ(disc.mode_numbers, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(disc.compliance.mode_numbers, (std::vector<int>{5}));
  EXPECT_FALSE(find_inertial_disc(disc));
}

TEST(InertialDisc, KeepsModesBesideShapesOfLittleMassFarAbove)
{
  // What a reduction has at 1 MHz moves a point of the ring by 1e4 per unit; a pad feels it as a
  // spring.
  const PlatePair umbrella{.n = 0, .f_Hz = 686.0, .mass = 4.2, .U = 0.7, .U_r = 8.5, .U_t = 0.0};
  const PlatePair far{.n = 5, .f_Hz = 1e6, .mass = 1.0, .U = 400.0, .U_r = 1e3, .U_t = 1e4};
  const Disc disc = disc_on_ring(analytic_body({umbrella, kirchhoff_2(), far}), "track", {});
  EXPECT_EQ(disc.mode_numbers, (std::vector<int>{1, 2, 3, 4, 5}));
  EXPECT_TRUE(disc.still.empty());
}

TEST(InertialDisc, KeepsRotationallySymmetricDamping)
{
  auto body = analytic_body({kirchhoff_2(), turned_pair()});
  body.C = Eigen::Vector4d{5.0, 5.0, 7.0, 7.0}.asDiagonal();
  const InertialDisc disc = inertial_disc(disc_on_ring(body, "track", {}));
  EXPECT_LT((disc.C - body.C).norm(), 1e-13);
  body.C(2, 2) = 9.0;
  EXPECT_NE(complaint(disc_on_ring(body, "track", {})).find("damping changes"), std::string::npos);
}

TEST(InertialDisc, TellsHowDifferentlyTheModesOfAPairDecay)
{
  // A small pair beside a strongly damped one: 2 % of the whole hides 60 % of the pair.
  auto body = analytic_body({kirchhoff_2(), turned_pair()});
  body.C = Eigen::Vector4d{500.0, 500.0, 7.0, 4.0}.asDiagonal();
  const InertialDisc disc = inertial_disc(disc_on_ring(body, "track", {}));
  EXPECT_NEAR(disc.damping_spread, 1.5, 1e-9);
  EXPECT_NEAR(disc.damping_contrast, 1.5 / 2.75, 1e-9);
  EXPECT_NEAR(disc.C(2, 2), 5.5, 1e-9);  // what the frame takes
}

TEST(InertialDisc, IsNoneWhereDifferencesAreKept)
{
  auto body = analytic_body({kirchhoff_2(), turned_pair()});
  body.C = Eigen::Vector4d{500.0, 500.0, 7.0, 4.0}.asDiagonal();
  Disc disc = disc_on_ring(body, "track", {});
  disc.keeps_asymmetry = true;
  EXPECT_FALSE(find_inertial_disc(disc));
  EXPECT_NE(complaint(disc).find("1.5 1/s of the damping of a pair"), std::string::npos);
}

/// Columns of the shapes and of the modes replaced by combinations of them, as an eigen-solver may
/// return modes of one frequency.
mbs_export::ModalBody mixed(mbs_export::ModalBody body, const Eigen::MatrixXd& by)
{
  mbs_export::ContactRing& ring = body.rings[0];
  for (Eigen::MatrixXd* shapes : {&ring.W, &ring.W_r, &ring.W_t}) *shapes = (*shapes * by).eval();
  return body;
}

Eigen::MatrixXd orthogonal(Eigen::Index n)
{
  srand(7);
  return linear::columns_of_Q(Eigen::HouseholderQR<Eigen::MatrixXd>(Eigen::MatrixXd::Random(n, n)),
                              n);
}

TEST(InertialDisc, FindsPairsInASpaceThatMixesThem)
{
  // 2 and 3 nodal diameters and an umbrella at one frequency.
  PlatePair two = kirchhoff_2(), three = kirchhoff_3();
  PlatePair umbrella{.n = 0, .f_Hz = two.f_Hz, .mass = 4.2, .U = 0.7, .U_r = 8.5, .U_t = 0.0};
  three.f_Hz = two.f_Hz;
  const auto body = mixed(analytic_body({two, umbrella, three}), orthogonal(5));
  const InertialDisc disc = inertial_disc(disc_on_ring(body, "track", {}));
  EXPECT_LT(disc.largest_impurity, 1e-6);
  std::vector<double> U;
  for (Eigen::Index i = 0; i < 5; ++i) U.push_back(std::abs(disc.rings[0].U[i]));
  std::ranges::sort(U);
  const double umbrella_U = 0.7 / std::sqrt(4.2), three_U = three.U / std::sqrt(three.mass),
               two_U = two.U / std::sqrt(two.mass);
  const std::vector<double> expected{umbrella_U, three_U, three_U, two_U, two_U};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(U[i], expected[i], 1e-12);
}

TEST(InertialDisc, FindsThePairsOfAMeshThatSplitsAndMixesThem)
{
  // Stiffness by which pairs of 3 and 4 diameters, 0.4 % apart, mix and split by 0.2 %.
  PlatePair three = kirchhoff_3(), four = kirchhoff_4();
  four.f_Hz = 1.004 * three.f_Hz;
  mbs_export::ModalBody body = analytic_body({three, four});
  srand(3);
  Eigen::MatrixXd K = body.omega.cwiseAbs2().asDiagonal();
  const Eigen::MatrixXd random = Eigen::MatrixXd::Random(4, 4);
  K += 1e-3 * K(0, 0) * (random + random.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(K);
  body = mixed(body, solver.eigenvectors());
  body.omega = solver.eigenvalues().cwiseSqrt();
  const InertialDisc disc = inertial_disc(disc_on_ring(body, "track", {}));
  EXPECT_LT(disc.largest_impurity, 1e-3);
  EXPECT_GT(disc.largest_split, 1e-4);
  for (Eigen::Index i = 0; i < 4; ++i) {
    EXPECT_NEAR(disc.omega[i],
                2.0 * pi * (disc.nodal_diameters[std::size_t(i)] == 3 ? three : four).f_Hz,
                2e-3 * disc.omega[i]);
  }
}

TEST(InertialDisc, LeavesModesInThePlaneAndTheUnpairedHarmonicOut)
{
  // Torsion whose axial motion, 6e-4 of that of the others, is noise, between the two modes of a
  // pair; and cos 30 theta on 60 nodes, which has no sine, with the little of another harmonic that
  // a mesh makes.
  PlatePair torsion{.n = 3, .f_Hz = 1749.9, .mass = 1.0, .U = 3e-4, .U_r = 6e-3, .U_t = 6e-3};
  mbs_export::ModalBody body =
      analytic_body({kirchhoff_2(),
                     kirchhoff_3(),
                     torsion,
                     {.n = 0, .f_Hz = 9e3, .mass = 1.0, .U = 0.0, .U_r = 0.0, .U_t = 0.0}});
  for (Eigen::Index j = 0; j < 60; ++j) {
    body.rings[0].W(j, 6) =
        (j % 2 == 0 ? 0.5 : -0.5) + 0.005 * std::cos(4.0 * pi * double(j) / 30.0);
  }
  for (Eigen::MatrixXd* shapes : {&body.rings[0].W, &body.rings[0].W_r, &body.rings[0].W_t})
    shapes->col(4).swap(shapes->col(3));
  std::swap(body.omega[3], body.omega[4]);
  const Disc disc = disc_on_ring(body, "track", {});
  EXPECT_EQ(disc.still, (std::vector<int>{4, 6}));
  EXPECT_EQ(disc.alternating, (std::vector<int>{7}));
  EXPECT_NE(notes_of(disc).at(0).find("take no part: 4, 6"), std::string::npos);
  EXPECT_NE(notes_of(disc).at(1).find("take no part: 7"), std::string::npos);
  EXPECT_EQ(inertial_disc(disc).nodal_diameters, (std::vector<int>{2, 2, 3, 3}));
}

TEST(InertialDisc, KeepsAPairThatOneOfTwoRingsShows)
{
  // On 60 nodes both modes of 15 diameters, on 30 nodes one of them, with twice the amplitude.
  mbs_export::ModalBody body = analytic_body(
      {kirchhoff_2(), {.n = 15, .f_Hz = 9e3, .mass = 1.0, .U = 0.5, .U_r = 5.0, .U_t = 50.0}});
  mbs_export::ContactRing outer = body.rings[0];
  outer.name = "outer";
  const auto every_second = Eigen::seqN(0, 30, 2);
  const mbs_export::ContactRing& inner = body.rings[0];
  outer.angles = inner.angles(every_second).eval();
  outer.W = 2.0 * inner.W(every_second, Eigen::seqN(0, 4));
  outer.W_r = 2.0 * inner.W_r(every_second, Eigen::seqN(0, 4));
  outer.W_t = Eigen::MatrixXd::Zero(30, 4);
  body.rings.push_back(outer);
  body.rings[0].W_t.rightCols(2).setZero();
  const Disc disc = make_disc(body, RingChoice{.names = {"track", "outer"}}, {});
  EXPECT_TRUE(disc.alternating.empty());
  EXPECT_EQ(disc.mode_numbers, (std::vector<int>{1, 2, 3, 4}));
}

TEST(InertialDisc, HasTorsionThatTurnsTheNormalsAlike)
{
  // All points of the ring lean along the circumference by the same angle, as between vanes.
  mbs_export::ModalBody body = analytic_body(
      {kirchhoff_2(), {.n = 0, .f_Hz = 2800.0, .mass = 2.0, .U = 0.0, .U_r = 0.0, .U_t = 0.0}});
  body.rings[0].W_t.col(2).setConstant(4.0);
  const Disc disc = disc_on_ring(body, "track", {});
  const InertialDisc inertial = inertial_disc(disc);
  EXPECT_LT(inertial.largest_impurity, 1e-6);
  const Eigen::VectorXd q = Eigen::Vector3d{0.0, 0.0, 0.3};
  EXPECT_NEAR(shapes_at(inertial, 0.9).W_t.dot(inertial.R.transpose() * q), 1.2, 1e-12);
}

}  // namespace
}  // namespace chladni::squeal
