// Friction contact near its kinks: slow growth, loss of contact, reversal of sliding, standstill.
#include <algorithm>
#include <cmath>

#include "common/eigen_every.hpp"
#include "hard_case.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/friction.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/error_budget.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"
#include "tests/squeal/source_disc.hpp"

namespace chladni::hard_cases {
namespace {

using namespace squeal;
using namespace squeal::test;

double growth_of(const PlatePair& pair, double speed)
{
  return least_stable_eigenvalue(
             state_matrix(inertial_disc(disc_of({pair})), reference_options(), speed))
      .real();
}

double critical_of(const std::vector<PlatePair>& pairs, const SquealOptions& options)
{
  const auto found = critical_speed(stability_over_speed(
      at_speeds(inertial_disc(disc_of(pairs)), options), options.study.speeds));
  return found ? found->speed / pi : std::nan("");
}

/// The body with five of the 60 nodes of its ring.
mbs_export::ModalBody with_five_nodes(mbs_export::ModalBody body)
{
  mbs_export::ContactRing& ring = body.rings[0];
  const auto chosen = Eigen::seqN(0, 5, 12);
  ring.angles = Eigen::VectorXd(ring.angles(chosen));
  for (Eigen::MatrixXd* shapes : {&ring.W, &ring.W_r, &ring.W_t})
    *shapes = Eigen::MatrixXd((*shapes)(chosen, every));
  return body;
}

/// What a finer mesh does to the growth of a pad, and the error told of it, 1/s.
struct OfAFinerMesh {
  double found, told;
};

/// With elements of a quarter of the size, two halvings that add 1e-10 m/N each to the compliance
/// at a point of the ring, and as much to each of its harmonics.
/// @param radius  of the pads, m; 0: a point
OfAFinerMesh on_a_finer_mesh(double radius)
{
  constexpr double growth = 1e-10, halvings = 2.0, speed = 6.0 * pi;
  mbs_export::ModalBody body = analytic_body({kirchhoff_3(), kirchhoff_4()});
  const Eigen::Index n = body.n_modes();
  body.certificate = {
      .fixed = body.fixed,
      .frequencies = body.omega,
      .eta2 = Eigen::VectorXd::Zero(n),
      .mesh_shape_errors = Eigen::MatrixXd::Zero(6, n),
      .mesh_errors = Eigen::VectorXd::Zero(n),
      .mesh_compliances = {.sets = {"track"}, .growth = Eigen::Vector3d(growth, 0.0, 0.0)}};
  SquealOptions options = reference_options();
  options.pads.front().radius = radius;
  const Disc disc = disc_on_ring(body, "track", {});
  InertialDisc finer = inertial_disc(disc);
  const auto lambda = least_stable_eigenvalue(state_matrix(finer, options, speed));
  const ErrorBudget budget = growth_error_budget(FlexibleDisc(disc, options), speed, lambda);
  const auto n_d = static_cast<std::size_t>(finer.errors.n_harmonics);
  finer.compliance.C.assign(n_d, Eigen::MatrixXcd::Zero(3, 3));
  for (std::size_t d = 0; d < n_d; ++d) {
    finer.compliance.C[d](0, 0) =
        (d == 0 ? 1.0 : 2.0) * halvings * growth / (2.0 * double(n_d) - 1.0);
  }
  const auto found = least_stable_eigenvalue(state_matrix(finer, options, speed));
  return {std::abs(found.real() - lambda.real()), budget.mesh.value()};
}

double cycle_frequency_error(ContactLaw law, double reference_Hz)
{
  const Disc disc = disc_of({kirchhoff_3(1672.13)});
  return std::abs(
      limit_cycle_direct(FlexibleDisc(disc, reference_options(law)), 6.0 * pi).frequency_Hz -
      reference_Hz);
}

/// Largest power that friction gives to the disc over sliding directions and speeds through zero.
double power_of_friction_through_zero()
{
  SquealOptions options = reference_options();
  options.friction.rise = 0.3;
  options.friction.regularisation = 1e-3;
  const PadContact pad =
      pad_contact(options, options.pads[0], faces_of_plate(options.thickness, ring_radius));
  double largest = -1e300;
  for (int i = -200; i <= 200; ++i) {
    const double speed = 1e-4 * i * std::abs(i);
    const RingMotion<double> m{0.0, 0.0, 0.0, 0.0, 0.3, -0.1};
    const PadState<double> up = pad_state(pad, m, speed, 1.0);
    largest = std::max(largest, up.f_r * -0.01 * 0.3 + up.f_t * (speed * ring_radius + 0.01 * 0.1));
  }
  return largest;
}

/// Velocity that is left after braking to rest with regularised friction, over the largest.
double motion_left_at_standstill()
{
  SquealOptions options = reference_options(ContactLaw::unilateral);
  options.friction.regularisation = 1e-3;
  const Transient run = transient(FlexibleDisc(disc_of({kirchhoff_3()}), options),
                                  {.speed = 20.0,
                                   .duration = 0.6,
                                   .initial_pad_displacement = 1e-6,
                                   .steps_per_period = 40,
                                   .speed_program = {{0.0, 20.0}, {0.1, 20.0}, {0.5, 0.0}}});
  double largest = 0.0;
  for (const double v : run.history.pad_velocity) largest = std::max(largest, std::abs(v));
  return run.finished ? std::abs(run.history.pad_velocity.back()) / largest : 1.0;
}

/// Largest error of the growth at 6 pi of the pair with frequencies 1, 3 and 10 Hz apart.
double growth_error_of_split_pairs()
{
  double worst = 0.0;
  for (const auto& [split_Hz, growth] :
       {std::pair{1.0, 2.681}, std::pair{3.0, 2.619}, std::pair{10.0, 2.265}}) {
    PlatePair pair = kirchhoff_3();
    pair.f_Hz -= 0.5 * split_Hz;
    pair.split = split_Hz / pair.f_Hz;
    pair.turn = 0.3;
    const double found = rotation_growth(disc_of({pair}), reference_options(), 6.0 * pi).growth;
    worst = std::max(worst, std::abs(found - growth));
  }
  return worst;
}

/// The fastest decay of the pair, 1/s.
double fastest_decay(double speed)
{
  const Eigen::MatrixXd A =
      state_matrix(inertial_disc(disc_of({kirchhoff_3()})), reference_options(), speed);
  return Eigen::EigenSolver<Eigen::MatrixXd>(A, false).eigenvalues().real().minCoeff();
}

/// Pad velocity of the limit cycle of 16 pairs, found directly, against the end of a transient of
/// 8 s that begins with a micrometre. Its fifth harmonic lies on the pair of seven nodal diameters.
double difference_in_the_five_to_one_resonance()
{
  std::vector<PlatePair> pairs;
  for (const PlatePair& pair : kirchhoff_modes())
    if (pair.n > 0) pairs.push_back(pair);
  std::swap(pairs[0], pairs[2]);  // the transient begins in the pair that squeals
  const Disc disc = disc_of(pairs);
  const SquealOptions options = reference_options(ContactLaw::unilateral);
  const LimitCycle settled = limit_cycle(
      transient(FlexibleDisc(disc, options),
                {.speed = 6.0 * pi, .duration = 8.0, .initial_pad_displacement = 1e-6}));
  return relative_error(limit_cycle_direct(FlexibleDisc(disc, options), 6.0 * pi).pad_velocity,
                        settled.settled ? settled.pad_velocity : std::nan(""));
}

/// Angular acceleration of the spin far from the slide, under the moment that balances friction at
/// rest; an independent program's values for the three laws of contact.
double error_of_the_spin_drift()
{
  double worst = 0.0;
  for (const auto& [law, exact] : {std::pair{ContactLaw::signed_force, -3071.5333341801065},
                                   std::pair{ContactLaw::bilateral, -3501.4997714942283},
                                   std::pair{ContactLaw::unilateral, -3283.067340264656}}) {
    const auto found =
        accelerate(source_disc(law), RigidMotion<double>{{-0.005, 0.004}, {20.0, 35.0}, 6.0 * pi},
                   Drive::moment);
    worst = std::max(worst, relative_error(found.spin_rate, exact));
  }
  return worst;
}

}  // namespace

std::vector<HardCase> contact_cases()
{
  const std::string area = "contact";
  return {
      {area, "pair whose frequencies a mesh parts by 1, 3 and 10 Hz",
       "the disc is no longer axisymmetric: no eigenvalues in the inertial frame",
       "error of the growth rate, 1/s", 1e-3, growth_error_of_split_pairs},
      {area, "creeping at 1e-4 pi rad/s",
       "friction damps like 1 / speed: one rate is 1e4 times the others",
       "relative error of the fastest decay", 0.01,
       [] { return relative_error(fastest_decay(1e-4 * pi), -4.4e5); }},
      {area, "creeping at 0.01 pi rad/s", "the growth is 1e-8 of omega",
       "error of the growth rate, 1/s", 5e-5,
       [] { return std::abs(growth_of(kirchhoff_3(), 0.01 * pi) - 1e-4); }},
      {area, "signed friction at 7 pi rad/s",
       "the relative velocity falls to 0.02 m/s, where friction turns within microseconds",
       "energy that 128 samples of a period leave over, of the work of friction", 0.02,
       [] {
         const CycleEnergy energy =
             limit_cycle_direct(FlexibleDisc(disc_of({kirchhoff_3()}),
                                             reference_options(ContactLaw::signed_force)),
                                7.0 * pi)
                 .energy;
         const double sum = energy.friction.sum() + energy.normal.sum() + energy.damping;
         return std::abs(sum) / energy.friction.cwiseAbs().sum();
       }},
      {area, "limit cycle that loses contact", "the force has a kink, 12 m/s at the pad",
       "error of the frequency, Hz", 1e-5,
       [] { return cycle_frequency_error(ContactLaw::unilateral, 1691.1221391516015); }},
      {area, "limit cycle with friction that follows the sign of N",
       "the relative velocity falls to 0.17 m/s and friction turns within microseconds",
       "error of the frequency, Hz", 1e-5,
       [] { return cycle_frequency_error(ContactLaw::signed_force, 1696.8746237948594); }},
      {area, "eigenvectors of a double frequency in any orientation",
       "FE solvers return a pair turned and reversed at will",
       "change of the critical speed over pi, rad/s", 1e-10,
       [] {
         PlatePair turned = kirchhoff_3();
         turned.turn = 0.7321;
         turned.sign = -1.0;
         return std::abs(critical_of({turned}, reference_options()) -
                         critical_of({kirchhoff_3()}, reference_options()));
       }},
      {area, "growth just above the critical speed", "0.0165 1/s is 1.5e-6 of omega",
       "error of the growth rate, 1/s", 1e-3,
       [] {
         const Growth found =
             growth(FlexibleDisc(disc_of({kirchhoff_3()}), reference_options()), 4.28 * pi, 3.0);
         return std::abs(found.rate - growth_of(kirchhoff_3(), 4.28 * pi));
       }},
      {area, "ring of five nodes under modes of three and four diameters",
       "four diameters look like one on five nodes", "words missing in the refusal", 0.0,
       [] {
         const auto body = with_five_nodes(analytic_body({kirchhoff_3(), kirchhoff_4()}));
         return words_missing([&] { refuse_aliases(disc_on_ring(body, "track", {}), body); },
                              {"ring \"track\" has 5 nodes", "10 nodes or more"});
       }},
      {area, "pad at a point of a mesh", "no mesh has the displacement of a force at a point",
       "change of the growth by finer elements over the error told", 1.0,
       [] {
         const OfAFinerMesh point = on_a_finer_mesh(0.0);
         return point.found / point.told;
       }},
      {area, "the same for a round pad of 30 mm", "the mesh counts for less than at a point",
       "the larger one of its change over that of a point, and over the error told", 1.0,
       [] {
         const OfAFinerMesh round = on_a_finer_mesh(0.03), point = on_a_finer_mesh(0.0);
         return std::max(round.found / round.told, round.found / point.found);
       }},
      {area, "35 modes up to 16 kHz, undamped", "the critical pair is not the one that squeals",
       "error of the critical speed over pi, rad/s", 5e-5,
       [] { return std::abs(critical_of(kirchhoff_modes(), reference_options()) - 4.02804); }},
      {area, "the same with 0.1 % of critical damping", "damping and pads couple all modes",
       "relative error of the critical speed", 1e-6,
       [] {
         Disc disc = disc_of(kirchhoff_modes());
         disc.C.diagonal() = 2e-3 * disc.omega;
         const auto found = critical_speed(
             stability_over_speed(at_speeds(inertial_disc(disc), reference_options()),
                                  reference_options().study.speeds));
         return found ? relative_error(found->speed / pi, 13.424694341511053) : 1.0;
       }},
      {area, "16 pairs up to 14 kHz, unilateral, at 6 pi rad/s",
       "the fifth harmonic of the squeal drives the pair of seven nodal diameters",
       "relative difference of the pad velocity, direct and at the end of 8 s", 5e-4,
       difference_in_the_five_to_one_resonance},
      {area, "limit cycle at 4.275 pi rad/s", "a disturbance decays by 7e-6 in a period",
       "relative error of the pad velocity", 1e-5,
       [] {
         return relative_error(
             limit_cycle_direct(FlexibleDisc(disc_of({kirchhoff_3()}), reference_options()),
                                4.275 * pi)
                 .pad_velocity,
             1.2273119873433587);
       }},
      {area, "ring of 60 nodes under a pad between them",
       "linear interpolation adds 0.026 1/s to the growth", "error of the growth rate, 1/s", 1e-3,
       [] {
         const Transient run =
             transient(FlexibleDisc(disc_of({kirchhoff_3(1672.13)}), reference_options()),
                       {.speed = 6.0 * pi,
                        .duration = 2.0,
                        .initial_pad_displacement = 1e-9,
                        .integrator = IntegratorKind::splitting});
         return run.growth_rate ? std::abs(*run.growth_rate - 2.775972925130693) : 1.0;
       }},
      {area, "rigid disc driven by a constant moment",
       "large motions brake more than the drive allows for: the spin drifts",
       "relative error of the angular acceleration", 1e-10, error_of_the_spin_drift},
      {area, "pads 1000 times stiffer than a brake's",
       "contact frequencies far above those of the disc: stiff equations",
       "relative error of the largest growth rate of all modes against its transient", 0.02,
       [] {
         SquealOptions options = reference_options();
         options.pads[0].stiffness = 6e9;
         options.pads[0].damping = 1e4;
         const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
         const double expected =
             least_stable_eigenvalue(state_matrix(inertial_disc(disc), options, 6.0 * pi)).real();
         const Transient run =
             transient(FlexibleDisc(disc, options),
                       {.speed = 6.0 * pi, .duration = 0.5, .initial_pad_displacement = 1e-9});
         return run.growth_rate ? relative_error(*run.growth_rate, expected) : 1.0;
       }},
      {area, "friction through zero relative velocity", "the direction of friction jumps",
       "largest power that friction gives, W", 0.0, power_of_friction_through_zero},
      {area, "braking to standstill", "Coulomb friction has no direction at rest",
       "motion left over the largest", 0.1, motion_left_at_standstill},
      {area, "sliding at speed 0", "the equilibrium does not exist without regularisation",
       "words missing in the refusal", 0.0,
       [] {
         return words_missing(
             [] {
               transient(FlexibleDisc(disc_of({kirchhoff_3()}), reference_options()),
                         {.speed = 0.0, .duration = 0.1, .initial_pad_displacement = 1e-6});
             },
             {"speed"});
       }},
      {area, "limit cycle of 40 m/s at 20 pi rad/s", "far beyond contact loss",
       "relative error of the pad velocity", 1e-4,
       [] {
         return relative_error(
             limit_cycle_direct(
                 FlexibleDisc(disc_of({kirchhoff_3()}), reference_options(ContactLaw::unilateral)),
                 20.0 * pi)
                 .pad_velocity,
             40.398);
       }},
  };
}

}  // namespace chladni::hard_cases
