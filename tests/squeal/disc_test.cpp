#include "squeal/brake/disc.hpp"

#include <gtest/gtest.h>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "squeal/brake/disc_ring.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/squeal/turning_discs.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

/// The text of the error that making the disc throws, empty when it does not.
std::string complaint_of_choice(const mbs_export::ModalBody& body, const ModeChoice& modes,
                                const std::string& ring = "track")
{
  try {
    disc_on_ring(body, ring, modes);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

ModeChoice nodal(int n)
{
  return {.nodal_diameters = n, .list = std::nullopt};
}
ModeChoice list(std::vector<int> modes)
{
  return {.nodal_diameters = std::nullopt, .list = std::move(modes)};
}

mbs_export::ModalBody three_pairs()
{
  return analytic_body({kirchhoff_2(), kirchhoff_3(), kirchhoff_4()});
}

TEST(Harmonics, InterpolateTrigonometricPolynomialsExactly)
{
  // A ring that does not begin at angle 0, odd and even: 11 nodes carry harmonics up to 5, 12 nodes
  // up to 5 and one function of harmonic 6.
  for (const int n : {11, 12}) {
    const Eigen::VectorXd angles = Eigen::VectorXd::LinSpaced(n, 0.3, 0.3 + 2 * pi * (n - 1.0) / n);
    const auto f = [](double x) { return 0.7 - 1.2 * std::cos(2 * x) + 0.4 * std::sin(5 * x); };
    const Harmonics harmonics = harmonics_of(angles, angles.unaryExpr(f));
    EXPECT_NEAR(harmonics.cosine(0, 0), 0.7, 1e-14);
    EXPECT_NEAR(harmonics.cosine(2, 0), -1.2, 1e-14);
    EXPECT_NEAR(harmonics.sine(5, 0), 0.4, 1e-14);
    EXPECT_NEAR(harmonics.cosine.squaredNorm() + harmonics.sine.squaredNorm(), 0.49 + 1.44 + 0.16,
                1e-13);
  }
}

TEST(Harmonics, ReturnAnyValuesAtTheNodes)
{
  const Eigen::VectorXd angles = Eigen::VectorXd::LinSpaced(8, 0.1, 0.1 + 2 * pi * 7 / 8);
  const Eigen::VectorXd values = (Eigen::VectorXd(8) << 3, -1, 4, 1, -5, 9, 2, -6).finished();
  const Harmonics f = harmonics_of(angles, values);
  const DiscRing ring{.name = "track", .radius = 1.0, .W = f, .W_r = f, .W_t = f};
  for (int j = 0; j < 8; ++j)
    EXPECT_NEAR(shapes_at(ring, angles[j]).W[0], values[j], 1e-13);  // rounding of 5 harmonics
}

TEST(Harmonics, RefuseUnequalSpacing)
{
  Eigen::VectorXd angles = Eigen::VectorXd::LinSpaced(8, 0.0, 2 * pi * 7 / 8);
  angles[3] += 1e-3;
  EXPECT_THROW(harmonics_of(angles, Eigen::MatrixXd::Zero(8, 1)), Error);
}

TEST(Disc, GivesTheShapesOfThePlateBetweenTheNodes)
{
  const PlatePair pair = kirchhoff_3();
  const Disc disc = disc_on_ring(analytic_body({pair}), "track", {});
  const double theta = 0.1234, root = std::sqrt(pair.mass);
  const Shapes shapes = shapes_at(disc, theta);
  EXPECT_NEAR(shapes.W[0] * root, pair.U * std::cos(3 * theta), 1e-13);
  EXPECT_NEAR(shapes.W_r[1] * root, pair.U_r * std::sin(3 * theta), 1e-12);
  EXPECT_NEAR(shapes.W_t[1] * root, pair.U_t * std::cos(3 * theta), 1e-12);
}

TEST(RingShapes, AgreeWithTheShapesOfTheDisc)
{
  const Disc disc = disc_on_ring(three_pairs(), "track", {});
  RingShapes ring(disc.rings.front());
  for (const double theta : {0.0, 1.7, -42.0}) {
    const Shapes shapes = shapes_at(disc, theta);
    const Eigen::MatrixX3d at = ring.at(theta);
    EXPECT_LT((at.col(0) - shapes.W).norm(), 1e-12);
    EXPECT_LT((at.col(1) - shapes.W_r).norm(), 1e-12);
    EXPECT_LT((at.col(2) - shapes.W_t).norm(), 1e-12);
  }
}

TEST(Disc, PicksTheLowestPairWithSoManyNodalDiameters)
{
  PlatePair higher = kirchhoff_3(7554.0);
  higher.U = 0.1;
  const auto body = analytic_body({kirchhoff_2(), kirchhoff_3(), kirchhoff_4(), higher});
  EXPECT_EQ(disc_on_ring(body, "track", nodal(3)).mode_numbers, (std::vector{3, 4}));
  EXPECT_EQ(nodal_diameters(disc_on_ring(body, "track", {})),
            (std::vector{2, 2, 3, 3, 4, 4, 3, 3}));
}

TEST(Disc, TakesListedModesInTheirOrderOfFrequency)
{
  const Disc disc = disc_on_ring(three_pairs(), "track", list({6, 5, 2, 1}));
  EXPECT_EQ(disc.mode_numbers, (std::vector{1, 2, 5, 6}));
  EXPECT_DOUBLE_EQ(disc.omega[2], 2 * pi * kirchhoff_4().f_Hz);
}

TEST(Disc, LeavesOutModesThatDoNotMoveTheRing)
{
  auto body = three_pairs();
  for (Eigen::MatrixXd* shape : {&body.rings[0].W, &body.rings[0].W_r, &body.rings[0].W_t})
    shape->col(2) *= 1e-9;
  EXPECT_EQ(disc_on_ring(body, "track", {}).mode_numbers, (std::vector{1, 2, 4, 5, 6}));
  EXPECT_NE(complaint_of_choice(body, list({2, 3})).find("mode 3 does not move the ring"),
            std::string::npos);
}

TEST(Disc, KeepsTheDampingOfTheChosenModes)
{
  auto body = three_pairs();
  body.C = Eigen::MatrixXd::Random(6, 6);
  const Disc disc = disc_on_ring(body, "track", list({3, 5}));
  EXPECT_EQ(disc.C(0, 1), body.C(2, 4));
  EXPECT_EQ(disc_on_ring(three_pairs(), "track", nodal(3)).C, Eigen::MatrixXd::Zero(2, 2));
}

TEST(Disc, HasTheCoriolisTermsOfATranslationInItsPlane)
{
  // Modes that move all mass by e_x and by e_y, of unit modal mass: S_xy of (x, y) is 1, and
  // G_ij = e_i . (e_z x e_j). With q'' + 2 Omega G q' a mass that nothing holds is deflected to its
  // right where the frame turns to the left.
  auto body = analytic_body({kirchhoff_3()});
  body.mass_integrals = integrals_with(Eigen::Matrix2d{{0.0, 1.0}, {0.0, 0.0}});
  EXPECT_EQ(disc_on_ring(body, "track", {}).G, (Eigen::Matrix2d{{0.0, -1.0}, {1.0, 0.0}}));
  // Of chosen modes the rows and columns of these.
  auto pairs = three_pairs();
  Eigen::MatrixXd S_xy = Eigen::MatrixXd::Zero(6, 6);
  S_xy(2, 4) = 0.25;
  pairs.mass_integrals = integrals_with(S_xy);
  EXPECT_EQ(disc_on_ring(pairs, "track", list({3, 5})).G,
            (Eigen::Matrix2d{{0.0, -0.25}, {0.25, 0.0}}));
  EXPECT_TRUE(disc_on_ring(three_pairs(), "track", list({3, 5})).G.isZero(0.0));
}

TEST(Disc, RefusesWhatTheBodyDoesNotHave)
{
  EXPECT_NE(complaint_of_choice(three_pairs(), {}, "brake"), "");
  EXPECT_NE(complaint_of_choice(three_pairs(), nodal(5)).find("5 nodal diameters"),
            std::string::npos);
  EXPECT_NE(complaint_of_choice(three_pairs(), list({1, 7})).find("modes 1 to 6"),
            std::string::npos);
  EXPECT_NE(complaint_of_choice(three_pairs(), list({0})).find("no mode 0"), std::string::npos);
  EXPECT_NE(complaint_of_choice(three_pairs(), list({2, 2})).find("twice"), std::string::npos);
  EXPECT_NE(complaint_of_choice(three_pairs(), list({})), "");
}

TEST(Disc, RefusesARingWhoseNodesDoNotRotate)
{
  auto still = three_pairs();
  still.rings[0].W_r.setZero();
  still.rings[0].W_t.setZero();
  EXPECT_NE(complaint_of_choice(still, {}).find("do not rotate"), std::string::npos)
      << complaint_of_choice(still, {});
}

TEST(Disc, RefusesAHeldRingAndAFreeBody)
{
  auto held = three_pairs();
  held.rings[0].W.setZero();
  held.rings[0].W_r.setZero();
  held.rings[0].W_t.setZero();
  EXPECT_NE(complaint_of_choice(held, {}).find("no mode of the body moves it"), std::string::npos);
  auto free = three_pairs();
  free.omega[1] = 1e-4;
  EXPECT_NE(complaint_of_choice(free, {}).find("hold the disc"), std::string::npos);
  EXPECT_EQ(complaint_of_choice(free, nodal(3)), "");
  free = three_pairs();
  free.kinds[0] = mbs_export::ModeKind::rigid;
  EXPECT_NE(complaint_of_choice(free, {}).find("mode 1 is a rigid-body motion"), std::string::npos);
}

/// The body with n of the 60 nodes of its ring.
mbs_export::ModalBody with_nodes(mbs_export::ModalBody body, Eigen::Index n)
{
  mbs_export::ContactRing& ring = body.rings[0];
  const auto chosen = Eigen::seqN(0, n, 60 / n);
  ring.angles = Eigen::VectorXd(ring.angles(chosen));
  for (Eigen::MatrixXd* shapes : {&ring.W, &ring.W_r, &ring.W_t})
    *shapes = Eigen::MatrixXd((*shapes)(chosen, every));
  return body;
}

std::string alias_in(const mbs_export::ModalBody& body, const ModeChoice& modes = {})
{
  try {
    refuse_aliases(disc_on_ring(body, "track", modes), body);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Of a plate that shears: its slopes are three quarters of those of its displacements.
PlatePair shearing_pair(int n, double f_Hz)
{
  return {n, f_Hz, 1.5, 0.6, 11.0, 0.75 * n * 0.6 / ring_radius};
}

TEST(Aliases, AreRefusedWithTheNumberOfNodesThatSuffices)
{
  const auto body = analytic_body(
      {kirchhoff_2(), kirchhoff_3(), kirchhoff_4(), shearing_pair(7, 6e3), shearing_pair(8, 7e3)});
  for (const Eigen::Index n : {5, 6, 10, 12, 15}) {
    const std::string text = alias_in(with_nodes(body, n));
    for (const char* word : {"ring \"track\"", "the 8 of the modes kept 18", "18 nodes or more"})
      EXPECT_NE(text.find(word), std::string::npos) << n << ": " << text;
  }
  EXPECT_EQ(alias_in(with_nodes(body, 20)), "");
  EXPECT_EQ(alias_in(body), "");
}

TEST(Aliases, AreToldByTheSlopesThatAreMostLikeThoseOfAThickPlate)
{
  // On 12 nodes waves of 4, 8, 16, 20 and 28 diameters look alike. Shear takes up to 60 % of a
  // slope.
  const auto told = [](int n, double part) {
    const auto body = analytic_body({{n, 6e3, 1.5, 0.6, 11.0, part * n * 0.6 / ring_radius}});
    const std::string text = alias_in(with_nodes(body, 12));
    const std::string of = "of ", alike = " nodal diameters looks like one of 4";
    const auto end = text.find(alike), begin = text.rfind(of, end);
    return end == std::string::npos ? 4 : std::stoi(text.substr(begin + of.size()));
  };
  for (const int n : {8, 16, 20, 28})
    for (const double part : {0.7, 0.9, 1.0}) EXPECT_EQ(told(n, part), n) << part;
  EXPECT_EQ(told(8, 0.42), 8);
  EXPECT_EQ(told(8, 0.38), 4) << "a slope of no wave with so few nodes";
  EXPECT_EQ(told(8, 1.28), 8);
  EXPECT_EQ(told(8, 1.32), 20) << "slopes of displacements are the larger ones";
}

TEST(Aliases, BeyondTheBandDoNotMatter)
{
  const auto body = with_nodes(analytic_body({kirchhoff_3(), shearing_pair(8, 7e3)}), 10);
  for (const double end_Hz : {6.9e3, 7.1e3}) {
    Disc disc = disc_on_ring(body, "track", {});
    disc.errors.range = 2.0 * pi * end_Hz;  // of the modes whose errors are known
    EXPECT_EQ(files::test::error_of([&] { refuse_aliases(disc, body); }).empty(), end_Hz < 7e3);
    mbs_export::ModalBody selected = body;  // for frequency responses up to there
    selected.kinds[1] = mbs_export::ModeKind::interface;
    selected.selection = mbs_export::SelectionTable{.error = 0.01,
                                                    .Omega_max = 2.0 * pi * end_Hz,
                                                    .loads = {},
                                                    .modes_only = {},
                                                    .with_interface_modes = {}};
    disc.errors.range = 0.0;
    EXPECT_EQ(files::test::error_of([&] { refuse_aliases(disc, selected); }).empty(), end_Hz < 7e3);
  }
}

TEST(Aliases, OfModesThatTakeNoPartDoNotMatter)
{
  auto body = analytic_body({kirchhoff_2(), kirchhoff_3(), shearing_pair(8, 7e3)});
  EXPECT_NE(alias_in(with_nodes(body, 10)), "");
  EXPECT_EQ(alias_in(with_nodes(body, 10), {.nodal_diameters = 3}), "");
  body.kinds[4] = body.kinds[5] = mbs_export::ModeKind::interface;
  EXPECT_EQ(alias_in(with_nodes(body, 10)), "");
}

TEST(Aliases, AreNamedWithTheDiametersThatTheyShow)
{
  const auto body = with_nodes(analytic_body({kirchhoff_2(), kirchhoff_3()}), 5);
  const std::string text = alias_in(body);
  EXPECT_NE(text.find("mode 3 (1749.7 Hz) of 3 nodal diameters looks like one of 2"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("8 nodes or more"), std::string::npos) << text;
}

TEST(Aliases, AreNoneWhereANodeDoesNotRotate)
{
  auto body = analytic_body({kirchhoff_2(), kirchhoff_4()});
  body.rings[0].W_t.rightCols(2).setZero();  // nothing tells 4 diameters from others
  EXPECT_EQ(alias_in(with_nodes(body, 10)), "");
}

/// Pairs of 3 and 4 diameters, with the motion of 12 circles of 48 points.
mbs_export::ModalBody pictured_pairs()
{
  mbs_export::ModalBody body = analytic_body({kirchhoff_3(), kirchhoff_4()});
  body.picture.positions.resize(12 * 48, 3);
  body.picture.transformation = Eigen::MatrixXd::Zero(3 * 12 * 48, 4);
  for (Eigen::Index at = 0; at < 12 * 48; ++at) {
    const double r = 0.05 + 0.01 * double(at / 48), theta = 2.0 * pi * double(at % 48) / 48.0;
    body.picture.positions.row(at) << r * std::cos(theta), r * std::sin(theta),
        body.rings[0].height;
    body.picture.transformation.row(3 * at + 2) << std::cos(3.0 * theta), std::sin(3.0 * theta),
        std::cos(4.0 * theta), std::sin(4.0 * theta);
  }
  return body;
}

TEST(Aliases, AreNoneWhereARibTurnsTheNodesOfTheRing)
{
  auto body = with_nodes(pictured_pairs(), 10);
  body.rings[0].W_t.rightCols(2) *= 3.5;  // as 14 diameters have them
  EXPECT_EQ(alias_in(body), "");
  body.picture = {};
  EXPECT_NE(alias_in(body).find("of 14 nodal diameters looks like one of 4"), std::string::npos);
}

}  // namespace
}  // namespace chladni::squeal
