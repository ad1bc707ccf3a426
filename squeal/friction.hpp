#pragma once

#include <cmath>
#include <complex>
#include <memory>

#include "squeal/friction_table.hpp"

namespace chladni::squeal {

/// Friction that depends on the speed of sliding v and takes its direction smoothly through zero:
///   T = -mu(v) N v_r / v,   mu(v) = mu + (mu_s - mu) exp(-v / v_s),   v = sqrt(|v_r|^2 + eps^2),
/// or mu(v, p) = mu table(v, p) with the pressure p of the pad, where there is a table.
/// The default is Coulomb's law with one coefficient, whose direction is undefined at rest.
/// With eps > 0 there is no sticking: a contact that should stick creeps at less than about eps.
struct FrictionLaw {
  double kinetic = 0.0;         ///< mu, far above `decay_speed`; of a table the factor
  double rise = 0.0;            ///< mu_s - mu: what friction gains towards rest, or loses
  double decay_speed = 1.0;     ///< v_s, m/s
  double regularisation = 0.0;  ///< eps, m/s
  std::shared_ptr<const FrictionTable> table = {};  ///< measured; without `rise`
  double temperature = 20.0;                        ///< of the table, degrees Celsius
};

/// v of the law: the speed of sliding, held away from zero.
template <class Scalar>
Scalar regularised_speed(const FrictionLaw& law, const Scalar& slip_squared)
{
  using std::sqrt;
  return sqrt(slip_squared + law.regularisation * law.regularisation);
}

/// table(v, p), to first order in the imaginary parts of complex steps.
inline double table_value(const FrictionLaw& law, double v, double p)
{
  return friction_at(*law.table, law.temperature, {v, p}).mu;
}
inline std::complex<double> table_value(const FrictionLaw& law, const std::complex<double>& v,
                                        const std::complex<double>& p)
{
  const FrictionValue f = friction_at(*law.table, law.temperature, {v.real(), p.real()});
  return {f.mu, f.by_speed * v.imag() + f.by_pressure * p.imag()};
}

/// mu at the regularised speed v and the pressure p (Pa).
template <class Scalar>
Scalar friction_coefficient(const FrictionLaw& law, const Scalar& v, const Scalar& p = Scalar(0.0))
{
  using std::exp;
  if (law.table) return law.kinetic * table_value(law, v, p);
  if (law.rise == 0.0) return Scalar(law.kinetic);
  return law.kinetic + law.rise * exp(-v / law.decay_speed);
}

/// The same law with all coefficients multiplied by `factor`.
inline FrictionLaw scaled(FrictionLaw law, double factor)
{
  law.kinetic *= factor;
  law.rise *= factor;
  return law;
}

/// A spring that stiffens, F = k x + k_3 x^3.
struct PadSpring {
  double linear;       ///< k, N/m
  double cubic = 0.0;  ///< k_3, N/m^3
};

template <class Scalar>
Scalar force(const PadSpring& spring, const Scalar& x)
{
  return (spring.linear + spring.cubic * x * x) * x;
}

}  // namespace chladni::squeal
