// Integrators on motions that last long, barely grow or change stiffness at a kink.
#include <cmath>

#include "hard_case.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/motion/dormand_prince.hpp"
#include "squeal/motion/generalised_alpha.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"

namespace chladni::hard_cases {
namespace {

using namespace squeal;
using namespace squeal::test;

/// x'' = -x above x = -c and -stop (x + c) + c below: a mass that meets a stiff stop, in closed
/// form.
class MassWithStop final : public Motion {
 public:
  MassWithStop(double c, double stop) : c_(c), stop_(stop) { omega_ << 1.0; }
  const Eigen::VectorXd& omega() const override { return omega_; }
  const Eigen::VectorXd& rate(double, const Eigen::VectorXd& y) override
  {
    s_[0] = y[0] + c_;
    f_ << y[1], -y[0] - (side_ < 0.0 ? (stop_ - 1.0) * (y[0] + c_) : 0.0);
    return f_;
  }
  const Eigen::VectorXd& switches() const override { return s_; }
  double side(Eigen::Index) const override { return side_; }
  void set_side(Eigen::Index, double side) override { side_ = side; }
  Tangent tangent(double, const Eigen::VectorXd&) override
  {
    return {Eigen::MatrixXd::Constant(1, 1, side_ < 0.0 ? -stop_ : -1.0),
            Eigen::MatrixXd::Zero(1, 1)};
  }

 private:
  double c_, stop_, side_ = 1.0;
  Eigen::VectorXd omega_{1}, s_{1}, f_{2};
};

/// Position error after `n` periods of a mass from x = 2 that meets a stop at -1.
double stop_error(double stop, int n)
{
  MassWithStop motion(1.0, stop);
  DormandPrince integrator(motion, 0.0, Eigen::Vector2d(2.0, 0.0), {1e-11, 1.0, 0.1});
  // Below the stop: x = -1 + 1 / stop + A sin(sqrt(stop) t + phi), from (-1, -sqrt 3).
  const double omega = std::sqrt(stop);
  const double phase = std::atan2(1.0 / stop, std::sqrt(3.0) / omega);
  const double period = 4.0 * pi / 3.0 + (pi - 2.0 * phase) / omega;
  return std::abs(integrator.at(n * period)[0] - 2.0);
}

/// Error of the growth rate that a transient shows, 1/s.
double growth_error(IntegratorKind kind, double speed, const std::vector<PlatePair>& pairs,
                    double duration)
{
  const Disc disc = disc_of(pairs);
  const Transient run = transient(
      FlexibleDisc(disc, reference_options()),
      {.speed = speed, .duration = duration, .initial_pad_displacement = 1e-9, .integrator = kind});
  const double expected =
      least_stable_eigenvalue(state_matrix(inertial_disc(disc), reference_options(), speed)).real();
  return run.growth_rate ? std::abs(*run.growth_rate - expected) : std::nan("");
}

/// Relative loss of energy of a free vibration over 20,000 periods.
double energy_drift()
{
  MassWithStop motion(1e9, 1.0);
  GeneralisedAlpha integrator(motion, 0.0, Eigen::Vector2d(1.0, 0.0), {1.0, 0.1 * pi, 0.1 * pi},
                              1.0);
  return std::abs(integrator.at(20000 * 2.0 * pi).squaredNorm() - 1.0);
}

}  // namespace

std::vector<HardCase> integration_cases()
{
  const std::string area = "integration", growth = "error of the growth rate, 1/s";
  return {
      {area, "mass against a stop 1e6 times stiffer",
       "the period changes from 6 to 0.003 at a kink", "error after 5 periods", 1e-6,
       [] { return stop_error(1e6, 5); }},
      {area, "growth of 0.0165 1/s, splitting", "1.5e-6 of omega: less than most schemes damp",
       growth, 1e-3 + 1e-4,
       [] { return growth_error(IntegratorKind::splitting, 4.28 * pi, {kirchhoff_3()}, 2.0); }},
      {area, "growth of 0.0165 1/s, exponential", "the same", growth, 1e-3 + 1e-4,
       [] { return growth_error(IntegratorKind::exponential, 4.28 * pi, {kirchhoff_3()}, 2.0); }},
      {area, "growth of 0.0165 1/s, Dormand-Prince", "the same", growth, 1e-3 + 1e-4,
       [] {
         return growth_error(IntegratorKind::dormand_prince, 4.28 * pi, {kirchhoff_3()}, 2.0);
       }},
      {area, "growth of 0.0165 1/s, generalised-alpha", "the same, implicit", growth, 1e-3 + 1e-4,
       [] {
         return growth_error(IntegratorKind::generalised_alpha, 4.28 * pi, {kirchhoff_3()}, 2.0);
       }},
      {area, "frequencies apart by 1e-7 of themselves", "a nearly double pair", growth, 1e-3 + 1e-4,
       [] {
         PlatePair pair = kirchhoff_3();
         pair.split = 1e-7;
         return growth_error(IntegratorKind::splitting, 6.0 * pi, {pair}, 2.0);
       }},
      {area, "20,000 periods of a free vibration", "any damping of the scheme adds up",
       "relative drift of the energy", 1e-9, energy_drift},
      {area, "7600 periods from 1e-7 m to the limit cycle",
       "any error of the growth adds up over 4.4 s", "relative error of the time to 99 % of it",
       2e-3,
       [] {
         const Disc disc = disc_of({kirchhoff_3(1672.13)});
         const Transient run =
             transient(FlexibleDisc(disc, reference_options()),
                       {.speed = 6.0 * pi, .duration = 5.0, .initial_pad_displacement = 6.8e-8});
         return relative_error(limit_cycle(run).t_99, 3.931);
       }},
      {area, "steps too long for the highest mode", "would show a frequency that does not exist",
       "words missing in the refusal", 0.0,
       [] {
         return words_missing(
             [] {
               transient(FlexibleDisc(disc_of(kirchhoff_modes()), reference_options()),
                         {.speed = 6.0 * pi,
                          .duration = 0.01,
                          .initial_pad_displacement = 1e-6,
                          .steps_per_period = 1});
             },
             {"step", "period"});
       }},
  };
}

}  // namespace chladni::hard_cases
