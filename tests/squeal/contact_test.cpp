#include "squeal/brake/contact.hpp"

#include <gtest/gtest.h>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/pad_system.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

PadContact reference_pad(ContactLaw law, double damping = 0.0)
{
  SquealOptions options = reference_options(law);
  options.pads[0].damping = damping;
  return pad_contact(options, options.pads[0], faces_of_plate(options.thickness, ring_radius));
}

/// Both pads on one middle surface.
template <class Scalar>
ContactResult<Scalar> contact_of(const PadContact& pad, const RingMotion<Scalar>& m, double speed)
{
  return contact(pad, PairMotion<Scalar>{m, m}, speed);
}

template <class Scalar>
RingForce<Scalar> force_of(const PadContact& pad, const RingMotion<Scalar>& m, double speed)
{
  const ContactResult<Scalar> at = contact_of(pad, m, speed);
  return pair_force(pad, m, at.upper, at.lower);
}

RingMotion<double> motion_of(const Shapes& shapes, const Eigen::VectorXd& q,
                             const Eigen::VectorXd& v)
{
  return {shapes.W.dot(q), shapes.W_r.dot(q), shapes.W_t.dot(q),
          shapes.W.dot(v), shapes.W_r.dot(v), shapes.W_t.dot(v)};
}

Eigen::VectorXd modal_force(const Shapes& shapes, const RingForce<double>& F)
{
  return F.F_w * shapes.W + F.F_r * shapes.W_r + F.F_t * shapes.W_t;
}

/// A state of plate modes with modal masses `mass`; the body's modes have mass 1.
struct PlateState {
  Eigen::VectorXd mass, q, v;
};

ContactResult<double> contact_in(const Shapes& shapes, const PlateState& x)
{
  const Eigen::VectorXd root = x.mass.cwiseSqrt();
  return contact_of(reference_pad(ContactLaw::bilateral),
                    motion_of(shapes, root.cwiseProduct(x.q), root.cwiseProduct(x.v)), 6.0 * pi);
}

Eigen::VectorXd force_in(const Shapes& shapes, const PlateState& x)
{
  const Eigen::VectorXd root = x.mass.cwiseSqrt();
  const RingMotion<double> m = motion_of(shapes, root.cwiseProduct(x.q), root.cwiseProduct(x.v));
  return modal_force(shapes, force_of(reference_pad(ContactLaw::bilateral), m, 6.0 * pi))
      .cwiseProduct(root);
}

/// h / (2 s) Omega (g . dg/dtheta): what the reference adds to the velocity of the upper pad. It
/// prints the full derivative of z = w + h s / 2, while the kernel stays in the tangent plane.
double normal_rate(const std::vector<PlatePair>& pairs, const Eigen::VectorXd& q, double speed)
{
  double g_r = 0.0, g_t = 0.0, dg_r = 0.0, dg_t = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PlatePair& pair = pairs[i];
    const double a = q[static_cast<Eigen::Index>(2 * i)],
                 b = q[static_cast<Eigen::Index>(2 * i + 1)];
    g_r += pair.U_r * a;
    g_t += pair.U_t * b;
    dg_r += pair.n * pair.U_r * b;
    dg_t -= pair.n * pair.U_t * a;
  }
  const double s = std::sqrt(1.0 + g_r * g_r + g_t * g_t);
  return 0.01 / s * speed * (g_r * dg_r + g_t * dg_t);
}

TEST(Contact, ReproducesTheReferenceStateOfOnePair)
{
  // SQUEAL reference values: an independent implementation in the inertial frame. The tolerances
  // are the rounding of sums of forces that are 1e4 times larger than the smallest result.
  const Disc disc = disc_of({kirchhoff_3()});
  const Shapes shapes = shapes_at(disc, 0.0);
  const double m = kirchhoff_3().mass;
  const PlateState x{Eigen::Vector2d{m, m}, Eigen::Vector2d{1e-3, -5e-4},
                     Eigen::Vector2d{3.0, 8.0}};
  const ContactResult<double> result = contact_in(shapes, x);
  const Eigen::VectorXd Q = force_in(shapes, x);
  EXPECT_NEAR(Q[0], -4671.319862472467, 1e-10 * 4671.0);
  EXPECT_NEAR(Q[1], 334.80848999020003, 1e-10 * 4671.0);
  EXPECT_NEAR(result.upper.z, 0.0106176389621003, 1e-12);
  EXPECT_NEAR(result.upper.z_dot - normal_rate({kirchhoff_3()}, x.q, 6.0 * pi), 1.8632608273103388,
              1e-10);
  EXPECT_NEAR(result.upper.N, 5739.218413695042, 1e-7);
  EXPECT_NEAR(result.lower.N, -1701.9975831443182, 1e-7);
  EXPECT_NEAR(result.upper.slip_speed, 1.3522489715726764, 1e-10);
}

TEST(Contact, ReproducesTheReferenceStateOfThreePairs)
{
  // SQUEAL reference values: an independent implementation in the rotating frame, pairs (2,0),
  // (3,0), (4,0) scaled to 1 at the rim.
  const std::vector<PlatePair> pairs{kirchhoff_2(), kirchhoff_3(), kirchhoff_4()};
  const Shapes shapes = shapes_at(disc_of(pairs), 0.0);
  PlateState x{Eigen::VectorXd(6), Eigen::VectorXd(6), Eigen::VectorXd(6)};
  x.q << 0.000172792096032393, 0.0004108090717505792, 0.00016521853809169356,
      -0.0006515786158021805, 0.0004526779333365589, 0.00022318728618200565;
  x.v << -2.6847661768014257, 2.9055905209817654, 1.8228619809303788, 1.4706624832776298,
      0.14211120657898393, 2.733564933062235;
  for (int i = 0; i < 6; ++i) x.mass[i] = pairs[static_cast<std::size_t>(i / 2)].mass;
  const ContactResult<double> result = contact_in(shapes, x);
  const Eigen::VectorXd Q = force_in(shapes, x);
  const double expected[] = {-3849.0845071373446, 252.04434629123708, -3487.79614378601,
                             342.69084065191765,  -3152.912526532923, 413.195222352852};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(Q[i], expected[i], 1e-10 * 4000.0) << "mode " << i;
  EXPECT_NEAR(result.upper.z, 0.010472376253529547, 1e-12);
  EXPECT_NEAR(result.upper.z_dot - normal_rate(pairs, x.q, 6.0 * pi), -0.6219769399288607, 1e-10);
  EXPECT_NEAR(result.upper.N, 4837.055528246104, 1e-7);
  EXPECT_NEAR(result.lower.N, -830.0422143552554, 1e-7);
  EXPECT_NEAR(result.upper.slip_speed, 1.4684050369625448, 1e-10);
}

TEST(Contact, LeavesTheFlatDiscInEquilibriumAtAnySpeed)
{
  for (const double speed : {0.1, 6.0 * pi, 300.0}) {
    const auto force =
        force_of(reference_pad(ContactLaw::unilateral, 20.0), RingMotion<double>{}, speed);
    EXPECT_EQ(force.F_w, 0.0);
    EXPECT_EQ(force.F_r, 0.0);
    EXPECT_EQ(force.F_t, 0.0);
  }
}

TEST(Contact, BalancesEachPadAlongItsAxis)
{
  // The axial part of normal and friction force is the pad force: N / s + sigma mu |N| t_z = S.
  const RingMotion<double> m{4e-4, 0.01, -0.02, 3.0, 40.0, -30.0};
  const PadContact pad = reference_pad(ContactLaw::bilateral, 50.0);
  const double s = std::sqrt(1.0 + m.g_r * m.g_r + m.g_t * m.g_t);
  for (const double sigma : {1.0, -1.0}) {
    const PadState<double> state = pad_state(pad, m, 6.0 * pi, sigma);
    const double lift = state.z - sigma * 0.01;
    EXPECT_NEAR(state.S, 2000.0 + sigma * (6e6 * lift + 50.0 * state.z_dot), 1e-9);
    // The normal part sigma N g / s is taken off f; the rest has the size mu |N| in the plane.
    const double t_z = (m.w_dot - state.z_dot) / state.slip_speed;
    EXPECT_NEAR(state.N / s + sigma * 0.6 * std::abs(state.N) * t_z, state.S, 1e-9);
    const double friction = std::hypot(state.f_r - sigma * state.N * m.g_r / s,
                                       state.f_t - sigma * state.N * m.g_t / s);
    EXPECT_NEAR(friction, 0.6 * std::abs(state.N) * std::sqrt(1.0 - t_z * t_z), 1e-9);
  }
}

TEST(Contact, LosesItsForceOnlyWhenUnilateral)
{
  // The lower pad is unloaded by 6e6 * 5e-4 = 3000 N from 2000 N.
  const RingMotion<double> up{5e-4, 0.001, 0.002, 0.0, 0.0, 0.0};
  const auto lower = [&](ContactLaw law) { return contact_of(reference_pad(law), up, 10.0).lower; };
  EXPECT_EQ(lower(ContactLaw::unilateral).N, 0.0);
  EXPECT_LT(lower(ContactLaw::bilateral).N, -900.0);
  EXPECT_LT(lower(ContactLaw::signed_force).N, -900.0);
  // On a pulling pad friction opposes the sliding (bilateral) or drives it (signed).
  EXPECT_LT(lower(ContactLaw::bilateral).f_t, 0.0);
  EXPECT_GT(lower(ContactLaw::signed_force).f_t, 0.0);
}

TEST(Contact, DoesNotDependOnTheLawWhileBothPadsPress)
{
  const RingMotion<double> m{1e-4, 0.003, -0.002, 0.5, 2.0, 4.0};
  const auto force = [&](ContactLaw law) { return force_of(reference_pad(law), m, 10.0); };
  const auto reference = force(ContactLaw::bilateral);
  for (const ContactLaw law : {ContactLaw::unilateral, ContactLaw::signed_force}) {
    EXPECT_EQ(force(law).F_w, reference.F_w);
    EXPECT_EQ(force(law).F_t, reference.F_t);
  }
}

TEST(PairDerivatives, AgreeWithDifferencesOfTheKernel)
{
  const PadContact pad = reference_pad(ContactLaw::bilateral, 30.0);
  const PairDerivatives D = pair_derivatives(pad, 15.0, middle_rows);
  // Second-order differences: error about step^2 of the nonlinear terms plus rounding / step.
  const double step = 1e-6;
  for (int j = 0; j < 6; ++j) {
    double x[6] = {};
    const auto force = [&](double value) {
      x[j] = value;
      const auto F = force_of(pad, RingMotion<double>{x[0], x[1], x[2], x[3], x[4], x[5]}, 15.0);
      return Eigen::Vector3d{F.F_w, F.F_r, F.F_t};
    };
    const Eigen::Vector3d difference = (force(step) - force(-step)) / (2.0 * step);
    const Eigen::Vector3d exact = (j < 3 ? D.D_a : D.D_p).col(j % 3);
    EXPECT_LT((difference - exact).norm(), 1e-6 * (1.0 + exact.norm())) << "column " << j;
  }
}

}  // namespace
}  // namespace chladni::squeal
