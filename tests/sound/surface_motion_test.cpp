#include "sound/surface_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <string>

#include "common/error.hpp"
#include "sound/air_mesh.hpp"
#include "tests/references/sound/thesis_disc.hpp"

namespace chladni::sound {
namespace {

const std::vector<MidLine> disc_line = {{.from = {testing::hub_radius, 0.0},
                                         .to = {testing::disc_radius, 0.0},
                                         .thickness = testing::disc_thickness}};

BodySurface surface_of(const Outline& outline, bool half_space)
{
  return body_surface(mesh_meridian(outline, {.order = 3,
                                              .element_size = 0.05,
                                              .edge_size = 0.005,
                                              .inner_radius = 0.22,
                                              .shell_thickness = 0.05,
                                              .half_space = half_space}));
}

TEST(Splines, HoldEveryCubic)
{
  const Splines splines(0.3, 4);
  const auto f = [](double s) { return 1.0 + s * (2.0 + s * (-3.0 + 5.0 * s)); };
  const auto slope = [](double s) { return 2.0 + s * (-6.0 + 15.0 * s); };
  Eigen::MatrixXd A(20, splines.size());
  Eigen::VectorXd y(20);
  for (int i = 0; i < 20; ++i) {
    A.row(i) = splines.values(0.3 * i / 19.0);
    y[i] = f(0.3 * i / 19.0);
  }
  const Eigen::VectorXd c = (A.transpose() * A).ldlt().solve(A.transpose() * y);
  for (const double s : {0.0, 0.07, 0.15, 0.3}) {
    EXPECT_NEAR(splines.values(s) * c, f(s), 1e-12);
    EXPECT_NEAR(splines.slopes(s) * c, slope(s), 1e-10);
  }
}

TEST(SurfaceMotion, FollowsTheModeOfTheDisc)
{
  const ThickBody thick = thick_body(disc_line, Hub::closed);
  const SurfaceMotion motion(testing::thesis_body(), thick, {0, 1}, {3});
  // 16 circles of nodes: the splines are cubic over 2 of their distances.
  EXPECT_LT(motion.residual().maxCoeff(), 1e-3);
  EXPECT_TRUE(motion.antisymmetric());
  const BodySurface surface = surface_of(thick.outline, true);
  const Eigen::VectorXd exact = testing::disc_velocity(surface, 1.0).real();
  const double scale = 1.0 / std::sqrt(testing::modal_mass);
  const Eigen::MatrixXd c = motion.on_meridian(surface, 0, Parity::cosine);
  const Eigen::MatrixXd s = motion.on_meridian(surface, 0, Parity::sine);
  EXPECT_LT((c.col(0) - scale * exact).cwiseAbs().maxCoeff(), 2e-3 * scale);
  EXPECT_LT((s.col(1) - scale * exact).cwiseAbs().maxCoeff(), 2e-3 * scale);
  EXPECT_LT(c.col(1).cwiseAbs().maxCoeff(), 1e-9);
}

/// The disc as a solid, of which the picture has both faces.
mbs_export::ModalBody solid_body()
{
  mbs_export::ModalBody body = testing::thesis_body();
  const mbs_export::Picture plate = body.picture;
  const double zeta = 0.5 * testing::disc_thickness, scale = 1.0 / std::sqrt(testing::modal_mass);
  mbs_export::Picture& picture = body.picture;
  const Eigen::Index n = plate.positions.rows();
  picture.positions = plate.positions.replicate(2, 1).eval();
  picture.transformation = plate.transformation.replicate(2, 1).eval();
  for (Eigen::Index i = 0; i < 2 * n; ++i) {
    const double x = picture.positions(i, 0), y = picture.positions(i, 1), r = std::hypot(x, y);
    const double phi = std::atan2(y, x), z = i < n ? zeta : -zeta;
    picture.positions(i, 2) = z;
    const Eigen::RowVector2d waves(std::cos(3.0 * phi), std::sin(3.0 * phi)),
        turned(-waves[1], waves[0]);
    const Eigen::RowVector2d u_r = -z * scale * testing::slope(r) * waves,
                             u_t = -z * scale * 3.0 / r * testing::deflection(r) * turned;
    picture.transformation.row(3 * i) = (x * u_r - y * u_t) / r;
    picture.transformation.row(3 * i + 1) = (y * u_r + x * u_t) / r;
  }
  return body;
}

TEST(SurfaceMotion, OfASolidIsThatOfItsMiddle)
{
  const ThickBody thick = thick_body(disc_line, Hub::closed);
  const SurfaceMotion plate(testing::thesis_body(), thick, {0, 1}, {3});
  const SurfaceMotion solid(solid_body(), thick, {0, 1}, {3});
  EXPECT_LT(solid.residual().maxCoeff(), 1e-3);
  EXPECT_TRUE(solid.antisymmetric());
  const BodySurface surface = surface_of(thick.outline, true);
  const Eigen::MatrixXd w = plate.on_meridian(surface, 0, Parity::cosine);
  // What the splines leave out of the slopes at the hub, times half the thickness.
  EXPECT_LT((solid.on_meridian(surface, 0, Parity::cosine) - w).norm(), 1e-3 * w.norm());
}

TEST(SurfaceMotion, OfTheClosedHubIsZero)
{
  const ThickBody thick = thick_body(disc_line, Hub::closed);
  const SurfaceMotion motion(testing::thesis_body(), thick, {0, 1}, {3});
  const BodySurface surface = surface_of(thick.outline, true);
  const Eigen::MatrixXd w = motion.on_meridian(surface, 0, Parity::cosine);
  for (Eigen::Index i = 0; i < w.rows(); ++i)
    if (surface.x(i, 0) < testing::hub_radius) {
      EXPECT_EQ(w(i, 0), 0.0);
    }
}

TEST(SurfaceMotion, FindsNothingInOtherHarmonics)
{
  const ThickBody thick = thick_body(disc_line, Hub::closed);
  const SurfaceMotion motion(testing::thesis_body(), thick, {0, 1}, {2});
  EXPECT_NEAR(motion.residual().maxCoeff(), 1.0, 1e-9);
}

TEST(SurfaceMotion, NeedsNodesInTheOutlineAndEnoughOfThem)
{
  const ThickBody elsewhere =
      thick_body({{.from = {0.025, 0.1}, .to = {0.162, 0.1}, .thickness = 0.02}}, Hub::closed);
  EXPECT_THROW(SurfaceMotion(testing::thesis_body(), elsewhere, {0}, {3}), Error);
  mbs_export::ModalBody bare = testing::thesis_body();
  bare.picture = {};
  EXPECT_THROW(SurfaceMotion(bare, thick_body(disc_line, Hub::closed), {0}, {3}), Error);
  const ThickBody longer = thick_body(
      {disc_line[0], {.from = {0.162, 0.0}, .to = {0.2, 0.0}, .thickness = 0.02}}, Hub::closed);
  EXPECT_THROW(SurfaceMotion(testing::thesis_body(), longer, {0}, {3}), Error);
}

/// Two rings at z = -h and h, each with the motion of the disc, and nodes between them.
mbs_export::ModalBody ventilated_body(double h, double vane_radius)
{
  const mbs_export::ModalBody disc = testing::thesis_body();
  const Eigen::Index n = disc.picture.positions.rows(), n_vane = 12;
  mbs_export::ModalBody body = disc;
  mbs_export::Picture& picture = body.picture;
  picture.positions = Eigen::MatrixX3d::Zero(2 * n + n_vane, 3);
  picture.transformation = Eigen::MatrixXd::Zero(3 * picture.positions.rows(), 2);
  for (const int side : {0, 1}) {
    picture.positions.middleRows(side * n, n) = disc.picture.positions;
    picture.positions.middleRows(side * n, n).col(2).setConstant(side == 0 ? -h : h);
    picture.transformation.middleRows(3 * side * n, 3 * n) = disc.picture.transformation;
  }
  for (Eigen::Index i = 0; i < n_vane; ++i)  // in the middle, with a motion of their own
    picture.positions.row(2 * n + i) << vane_radius * std::cos(0.5 * double(i)),
        vane_radius * std::sin(0.5 * double(i)), 0.0;
  picture.transformation.bottomRows(3 * n_vane).setConstant(100.0);
  return body;
}

ThickBody two_rings(double h)
{
  const auto ring = [](double z) {
    return MidLine{
        .from = {testing::hub_radius, z}, .to = {testing::disc_radius, z}, .thickness = 0.008};
  };
  return thick_body({ring(-h), ring(h)}, Hub::open);
}

TEST(SurfaceMotion, DoesNotLookAtVanesBetweenTwoRings)
{
  const double h = 0.012;
  const SurfaceMotion motion(ventilated_body(h, 0.1), two_rings(h), {0, 1}, {3});
  EXPECT_EQ(motion.inner_nodes(), 12);
  EXPECT_LT(motion.residual().maxCoeff(), 1e-3);
  const SurfaceMotion disc(testing::thesis_body(), thick_body(disc_line, Hub::closed), {0, 1}, {3});
  EXPECT_EQ(disc.inner_nodes(), 0);
}

TEST(SurfaceMotion, RefusesNodesBesideTheRings)
{
  try {
    SurfaceMotion(ventilated_body(0.012, 0.18), two_rings(0.012), {0, 1}, {3});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("(0.18, 0) m"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("not between two"), std::string::npos);
  }
}

TEST(Outline, ContainsWhatIsInsideIt)
{
  const Outline disc = thick_body(disc_line, Hub::closed, {{0.1, 0.01, 4}}).outline;
  EXPECT_TRUE(contains(disc, {0.0, 0.0, 0.0}));
  EXPECT_TRUE(contains(disc, {0.0, 0.16, 0.009}));
  EXPECT_FALSE(contains(disc, {0.0, 0.16, 0.011}));
  EXPECT_FALSE(contains(disc, {0.0, 0.163, 0.0}));
  EXPECT_FALSE(contains(disc, {0.1, 0.0, 0.0})) << "a hole";
  EXPECT_TRUE(contains(disc, {0.08, 0.08, 0.0})) << "between two holes";
  EXPECT_FALSE(contains(thick_body(disc_line, Hub::open).outline, {0.01, 0.0, 0.0}));
}

TEST(Outline, OfADiscIsMirroredAndOfAHatIsNot)
{
  EXPECT_TRUE(mirrored(thick_body(disc_line, Hub::closed).outline));
  const std::vector<MidLine> hat = {{.from = {0.08, 0.0}, .to = {0.16, 0.0}, .thickness = 0.02},
                                    {.from = {0.08, 0.0}, .to = {0.08, 0.05}, .thickness = 0.008},
                                    {.from = {0.03, 0.05}, .to = {0.08, 0.05}, .thickness = 0.008}};
  const ThickBody body = thick_body(hat, Hub::closed);
  EXPECT_FALSE(mirrored(body.outline));
  EXPECT_TRUE(contains(body.outline, {0.0, 0.0, 0.05})) << "the plug of the hub";
  EXPECT_FALSE(contains(body.outline, {0.0, 0.0, 0.0}));
}

TEST(Outline, IsHeldByTheSmallestBall)
{
  const Ball ball = enclosing_ball(thick_body(disc_line, Hub::closed).outline);
  EXPECT_EQ(ball.z, 0.0);
  EXPECT_NEAR(ball.radius, std::hypot(0.162, 0.01), 1e-12);
}

TEST(ThickBody, NeedsPiecesWithLengthAndThickness)
{
  EXPECT_THROW(thick_body({}, Hub::closed), Error);
  EXPECT_THROW(thick_body({{.from = {0.1, 0.0}, .to = {0.1, 0.0}, .thickness = 0.01}}, Hub::open),
               Error);
  EXPECT_THROW(thick_body({{.from = {-0.1, 0.0}, .to = {0.1, 0.0}, .thickness = 0.01}}, Hub::open),
               Error);
}

}  // namespace
}  // namespace chladni::sound
