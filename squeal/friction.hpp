#pragma once

#include <cmath>

namespace chladni::squeal {

/// Friction that depends on the speed of sliding v and takes its direction smoothly through zero:
///   T = -mu(v) N v_r / v,   mu(v) = mu + (mu_s - mu) exp(-v / v_s),   v = sqrt(|v_r|^2 + eps^2).
/// The default is Coulomb's law with one coefficient, whose direction is undefined at rest.
/// With eps > 0 there is no sticking: a contact that should stick creeps at less than about eps.
struct FrictionLaw {
  double kinetic = 0.0;         ///< mu, far above `decay_speed`
  double rise = 0.0;            ///< mu_s - mu: what friction gains towards rest
  double decay_speed = 1.0;     ///< v_s, m/s
  double regularisation = 0.0;  ///< eps, m/s
};

/// v of the law: the speed of sliding, held away from zero.
template <class Scalar>
Scalar regularised_speed(const FrictionLaw& law, const Scalar& slip_squared)
{
  using std::sqrt;
  return sqrt(slip_squared + law.regularisation * law.regularisation);
}

/// mu(v) = mu + (mu_s - mu) exp(-v / v_s) at the regularised speed v.
template <class Scalar>
Scalar friction_coefficient(const FrictionLaw& law, const Scalar& v)
{
  using std::exp;
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
