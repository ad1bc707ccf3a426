#include "squeal/stability/period_work.hpp"

#include <cmath>
#include <numbers>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/motion/sliding_disc.hpp"

namespace chladni::squeal {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
/// Of a period: what is linear in the motion cancels, what is quadratic has two waves.
constexpr int n_phases = 8;
/// Energy of the first motion that is tried, J, and the factor from one to the next.
constexpr double first_energy = 1e-8;
constexpr double smaller = 1e-2;
constexpr int n_energies = 8;
/// Change of the works, relative, from which on they are those of the linear motion.
constexpr double linear = 1e-6;

double size_of(const PeriodWork& work)
{
  return std::abs(work.friction) + std::abs(work.normal) + std::abs(work.damping);
}

/// Powers relative to the energy, both means over the phases, times a period.
PeriodWork work_at(SlidingDisc& motion, const Eigen::VectorXcd& u, double period)
{
  PeriodWork work{};
  double energy = 0.0;
  for (int i = 0; i < n_phases; ++i) {
    const Eigen::VectorXd x = (u * std::polar(1.0, two_pi * i / n_phases)).real();
    const SlidingDisc::Power power = motion.sample(x).power;
    work.friction += power.friction.sum();
    work.normal += power.normal.sum();
    work.damping += power.damping;
    energy += 0.5 * x.squaredNorm();
  }
  const double scale = period / energy;
  return {scale * work.friction, scale * work.normal, scale * work.damping};
}

}  // namespace

PeriodWork period_work(const FlexibleDisc& brake, double speed, std::complex<double> lambda,
                       const Eigen::VectorXcd& u)
{
  SlidingDisc motion(brake.inertial(), brake.options(), speed);
  const double period = two_pi / lambda.imag();
  Eigen::VectorXcd v = u * (2.0 * std::sqrt(first_energy) / u.norm());
  PeriodWork work = work_at(motion, v, period);
  for (int i = 1; i < n_energies; ++i) {
    v *= std::sqrt(smaller);
    const PeriodWork now = work_at(motion, v, period);
    const double change = size_of(
        {now.friction - work.friction, now.normal - work.normal, now.damping - work.damping});
    work = now;
    if (change < linear * size_of(now)) break;
  }
  return work;
}

}  // namespace chladni::squeal
