// Two contact planes: each with a ring of its own, or off the middle of one ring.
#include "squeal/brake/pad_system.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "squeal/motion/disc_motion.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/hill.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/squeal/linked_rings.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using mbs_export::ContactRing;
using mbs_export::ModalBody;

TEST(ContactPlanes, OnRingsInBothFacesOfAPlateAreThoseOfItsMiddleSurface)
{
  const ModalBody body = linked_body(three_pairs(), {-0.01, 0.01});
  const SquealOptions middle = brake_options();
  const Eigen::MatrixXd A = matrix_of_brake(body, middle);
  EXPECT_LT((matrix_of_brake(body, on_faces(middle)) - A).norm(), 1e-13 * A.norm());
  // Without the lever of the faces friction would not drive the disc.
  const ModalBody flat = linked_body(three_pairs(), {-0.005, 0.005});
  EXPECT_GT(
      (matrix_of_brake(flat, on_rings(middle, "ring 1",
                                      {.opposite_ring = "ring 2", .heights = {{-0.005, 0.005}}})) -
       A)
          .norm(),
      1e-6 * A.norm());
}

TEST(ContactPlanes, DoNotDependOnWhereTheirRingsLie)
{
  // One ring for both, 3 mm above the middle; or two, one inside the plate and one outside it.
  const ModalBody body = linked_body(three_pairs(), {0.003, -0.007, 0.012});
  const SquealOptions middle = brake_options();
  const Eigen::MatrixXd A = matrix_of_brake(body, middle);
  const std::array<double, 2> planes{-0.01, 0.01};
  const SquealOptions one = on_rings(middle, "ring 1", {.heights = planes});
  EXPECT_LT((matrix_of_brake(body, one) - A).norm(), 1e-13 * A.norm());
  const SquealOptions two =
      on_rings(middle, "ring 3", {.opposite_ring = "ring 2", .heights = planes});
  EXPECT_LT((matrix_of_brake(body, two) - A).norm(), 1e-13 * A.norm());
}

TEST(ContactPlanes, AreThoseOfTheMiddleSurfaceUnderHillAndFloquet)
{
  const ModalBody body = linked_body({kirchhoff_2(), kirchhoff_3()}, {-0.01, 0.01});
  SquealOptions middle = brake_options();
  middle.pads.pop_back();
  const SquealOptions faces = on_faces(middle);
  const double speed = 8.0 * pi;
  const Disc plate = disc_for(body, middle), disc = disc_for(body, faces);
  const double growth = rotation_growth(plate, middle, speed).growth;
  EXPECT_NEAR(rotation_growth(disc, faces, speed).growth, growth, 1e-9);
  const auto by_hill = [&](const Disc& of, const SquealOptions& options) {
    return Hill(of, options).exponents(speed).lambda[0].real();
  };
  EXPECT_NEAR(by_hill(disc, faces), by_hill(plate, middle), 1e-9);
}

/// Contact is lost and regained, slopes reach 1e-2.
Eigen::VectorXd large_state_of_planes(Eigen::Index n)
{
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) x[i] = 6.0 * std::sin(1.0 + 2.0 * double(i));
  return x;
}

TEST(ContactPlanes, AreTheSameInLargeMotionsAndInBothFrames)
{
  const ModalBody body = linked_body(three_pairs(), {-0.01, 0.01});
  SquealOptions middle = brake_options(ContactLaw::unilateral);
  middle.pads.pop_back();
  const SquealOptions faces = on_faces(middle);
  const Disc disc = disc_for(body, faces);
  const InertialDisc inertial = inertial_disc(disc);
  const double speed = 18.0;
  SlidingDisc plate(inertial_disc(disc_for(body, middle)), middle, speed);
  SlidingDisc sliding(inertial, faces, speed);
  RotatingDisc rotating(disc, faces, speed);
  EXPECT_EQ(sliding.rate(0.0, Eigen::VectorXd::Zero(12)).norm(), 0.0);
  const Eigen::VectorXd x = large_state_of_planes(12);
  sliding.take_sides(0.0, x);
  plate.take_sides(0.0, x);
  // The lever is h / 2 here and h / (2 s) there: s - 1 is 3e-5.
  const Eigen::VectorXd rate = sliding.rate(0.0, x), of_plate = plate.rate(0.0, x);
  EXPECT_LT((rate - of_plate).norm(), 1e-7 * rate.norm());
  EXPECT_LT((sliding.jacobian(x) - plate.jacobian(x)).norm(), 1e-5 * plate.jacobian(x).norm());
  Eigen::VectorXd y(12);
  y << inertial.R * x.head<6>(), inertial.R * x.tail<6>();
  rotating.take_sides(0.0, y);
  const Eigen::VectorXd q_rate = rotating.rate(0.0, y).tail<6>();
  const Eigen::VectorXd force = rate.tail<6>() + speed * inertial.D * x.tail<6>();
  EXPECT_LT((inertial.R * force - q_rate).norm(), 1e-12 * force.norm());
}

TEST(ContactPlanes, GrowInTransientsAsTheirEigenvaluesSay)
{
  const ModalBody body = linked_body({kirchhoff_3()}, {-0.01, 0.01});
  const SquealOptions faces = on_faces(reference_options());
  const Disc disc = disc_for(body, faces);
  const double exact =
      least_stable_eigenvalue(state_matrix(inertial_disc(disc), faces, 6.0 * pi)).real();
  EXPECT_NEAR(exact, 2.689075, 1e-6);  // of the middle surface, SQUEAL 2.5
  for (const IntegratorKind kind :
       {IntegratorKind::splitting, IntegratorKind::exponential, IntegratorKind::dormand_prince}) {
    const Transient run = transient(
        FlexibleDisc(disc, faces),
        {.speed = 6.0 * pi, .duration = 1.0, .initial_pad_displacement = 1e-8, .integrator = kind});
    ASSERT_TRUE(run.growth_rate);
    EXPECT_NEAR(*run.growth_rate, exact, 2e-3) << run.integrator;  // of the mesh of times
  }
}

/// A pair of n diameters in the plane, cos n and sin n for V_r and -V_t, and its factor on each
/// ring of the body; mass 1.
void add_pair_in_plane(ModalBody& body, int n, double f_Hz, const std::vector<double>& factors)
{
  const double V_r = 0.5, V_t = 0.8;
  const Eigen::Index m = body.n_modes();
  body.omega.conservativeResize(m + 2);
  body.omega.tail<2>().setConstant(2.0 * pi * f_Hz);
  body.kinds.resize(static_cast<std::size_t>(m + 2), mbs_export::ModeKind::constrained);
  const Eigen::Index n_rows = body.attachment_modes.rows();
  body.attachment_modes.conservativeResizeLike(Eigen::MatrixXd::Zero(n_rows, m + 2));
  for (std::size_t at = 0; at < body.rings.size(); ++at) {
    ContactRing& ring = body.rings[at];
    for (Eigen::MatrixXd* f : {&ring.W, &ring.W_r, &ring.W_t})
      f->conservativeResizeLike(Eigen::MatrixXd::Zero(f->rows(), m + 2));
    for (std::size_t i = 0; i < ring.nodes.size(); ++i)
      for (int k = 0; k < 2; ++k) {
        const double theta = ring.angles[static_cast<Eigen::Index>(i)];
        const double x = n * theta - k * 0.5 * pi;
        const double v_r = V_r * std::cos(x), v_t = -V_t * std::sin(x);
        auto u = body.attachment_modes.block<2, 1>(6 * ring.nodes[i], m + k);
        u << std::cos(theta) * v_r - std::sin(theta) * v_t,
            std::sin(theta) * v_r + std::cos(theta) * v_t;
        u *= factors[at];
      }
  }
}

TEST(ContactPlanes, LetFrictionActOnModesInThePlane)
{
  // A pair in the plane alone: pads do not see its frequency, but friction damps it as it slides
  // radially, by mu N_0 / (Omega r) of each pad, and nowhere along the circumference.
  ModalBody body = linked_body({kirchhoff_3()}, {-0.01, 0.01});
  add_pair_in_plane(body, 2, 5000.0, {0.0, 1.0, 1.0});
  SquealOptions options = on_faces(reference_options());
  options.pads[0].stiffness = 1.0;  // uncoupled from the motion along the axis
  const Disc disc = disc_for(body, options);
  ASSERT_EQ(disc.n_modes(), 4);
  const double speed = 20.0;
  const Eigen::MatrixXd A = state_matrix(inertial_disc(disc), options, speed);
  // Second half of x, modes 3 and 4: p' = ... - C p; cosine and sine at the pad.
  const double radial = 2.0 * 0.6 * 2000.0 / (speed * 0.13) * 0.25;
  EXPECT_NEAR(A(6, 6), -radial, 1e-9 * radial);
  EXPECT_NEAR(A(7, 7), 0.0, 1e-9 * radial);
  // On the middle surface these modes take no part.
  EXPECT_EQ(disc_for(body, reference_options()).still, (std::vector{3, 4}));
  // The static friction of both pads, 2 mu N_0, bends the disc to its equilibrium; it is no motion.
  SlidingDisc sliding(inertial_disc(disc), options, speed);
  EXPECT_EQ(sliding.rate(0.0, Eigen::VectorXd::Zero(8)).norm(), 0.0);
}

TEST(ContactPlanes, OfTwoPlatesThatMoveByThemselvesGrowAlikeInAllFrames)
{
  // The upper plate stretches and lifts in a pair of its own: the springs of its pad couple it to
  // the bending of the whole disc, and friction to its own stretching. Faces that stretch alike
  // would not feel that: it cancels between both pads.
  ModalBody body = linked_body({kirchhoff_3()}, {-0.01, 0.01});
  add_pair_in_plane(body, 3, 1900.0, {0.0, 0.0, 1.0});
  ContactRing& upper = body.rings[2];
  upper.W.col(2) = 0.3 * (3.0 * upper.angles.array()).cos();
  upper.W.col(3) = 0.3 * (3.0 * upper.angles.array()).sin();
  const SquealOptions options = on_faces(reference_options());
  const Disc disc = disc_for(body, options);
  const double speed = 10.0 * pi;
  const double growth =
      least_stable_eigenvalue(state_matrix(inertial_disc(disc), options, speed)).real();
  EXPECT_NEAR(rotation_growth(disc, options, speed).growth, growth, 1e-3);
  EXPECT_NEAR(Hill(disc, options).exponents(speed).lambda[0].real(), growth, 1e-6);
  // Without the pair in the plane another one.
  SquealOptions alone = reference_options();
  const double of_plate =
      least_stable_eigenvalue(state_matrix(inertial_disc(disc_for(body, alone)), alone, speed))
          .real();
  EXPECT_GT(std::abs(growth - of_plate), 0.1);
}

std::string complaint_of_planes(const ModalBody& body, const SquealOptions& options)
{
  try {
    pad_system(options, ring_places(disc_for(body, options)));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ContactPlanes, SayWhichKeyMakesWhatIsMissing)
{
  const ModalBody body = linked_body({kirchhoff_3()}, {-0.01, 0.01, 0.01});
  EXPECT_EQ(complaint_of_planes(body, on_faces(reference_options())), "");
  // "track" has no displacements in the plane.
  const std::string in_plane = complaint_of_planes(
      body, on_rings(reference_options(), "track", {.opposite_ring = "ring 1"}));
  EXPECT_NE(in_plane.find("interface.nodes = [\"track\", ...]"), std::string::npos) << in_plane;
  const std::string height = complaint_of_planes(
      body, on_rings(reference_options(), "ring 2", {.opposite_ring = "ring 3"}));
  EXPECT_NE(height.find("both lie at z = 0.01 m"), std::string::npos) << height;
  EXPECT_NE(complaint_of_planes(
                body, on_rings(reference_options(), "ring 2", {.opposite_ring = "ring 9"})),
            "");
  SquealOptions beside = reference_options();
  beside.slopes_from = {"ring 1"};  // at another height
  const std::string slopes = complaint_of_planes(body, beside);
  EXPECT_NE(slopes.find("no ring of slopes_from lies at its height"), std::string::npos) << slopes;
  EXPECT_NE(slopes.find("slopes_from, or reduce it with the rotations"), std::string::npos);
}

}  // namespace
}  // namespace chladni::squeal
