#pragma once

#include <cmath>
#include <complex>
#include <memory>
#include <vector>

namespace chladni::squeal {

/// mu over the sliding speed at one pressure and temperature: a piecewise cubic with one slope at
/// each point, limited so that it is monotone where the points are, and constant outside the
/// points.
/// Source: F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300.
struct FrictionCurve {
  std::vector<double> speeds;       ///< m/s, ascending; a single speed means a constant
  std::vector<double> mu;           ///< friction coefficient at each speed
  std::vector<double> slopes = {};  ///< d mu / d v at each speed, s/m, set by friction_curve
};

/// The curve through the points, with its slopes.
FrictionCurve friction_curve(std::vector<double> speeds, std::vector<double> mu);

/// Measured friction: a curve over the speed for each pressure and temperature. Interpolation is
/// cubic over the pressure, with slopes of parabolas through three points, and linear over the
/// temperature; values are constant outside the first and last points.
struct FrictionTable {
  std::vector<double> temperatures = {};  ///< degrees Celsius, ascending; empty: independent of it
  std::vector<double> pressures = {};     ///< Pa, ascending; empty: independent of it
  std::vector<FrictionCurve> curves;      ///< for each temperature in turn, one for each pressure
};

/// The ranges that all curves of a table cover.
struct FrictionRange {
  double speed_from, speed_to;        ///< m/s; 0 to infinity for constants
  double pressure_from, pressure_to;  ///< Pa; 0 to infinity for constants
  /// Degrees Celsius; -infinity to infinity without temperatures.
  double temperature_from, temperature_to;
};
/// The ranges that all curves of the table cover.
FrictionRange range_of(const FrictionTable& table);

/// Arguments of the table.
struct FrictionPlace {
  double speed, pressure;  ///< m/s, Pa
};

/// Friction coefficient and its derivatives.
struct FrictionValue {
  double mu, by_speed, by_pressure;  ///< 1, s/m, 1/Pa
};

/// Friction coefficient and derivatives at a temperature (degrees Celsius), speed and pressure.
FrictionValue friction_at(const FrictionTable& table, double temperature,
                          const FrictionPlace& place);

/// Friction law with a coefficient that depends on the sliding speed v and a direction that is
/// smooth through zero:
///   T = -mu(v) N v_r / v,   mu(v) = mu + (mu_s - mu) exp(-v / v_s),   v = sqrt(|v_r|^2 + eps^2),
/// or, with a table, mu(v, p) = mu table(v, p) with the pad pressure p. The default is Coulomb's
/// law with one coefficient, whose direction is undefined at rest. With eps > 0 there is no
/// sticking: a contact that should stick creeps with a speed of about eps or less.
struct FrictionLaw {
  /// Kinetic coefficient mu, for v far above `decay_speed`; with a table a factor on it.
  double kinetic = 0.0;
  double rise = 0.0;            ///< mu_s - mu, the change of friction towards rest; < 0: it falls
  double decay_speed = 1.0;     ///< v_s, m/s
  double regularisation = 0.0;  ///< eps, m/s
  std::shared_ptr<const FrictionTable> table = {};  ///< measured values; `rise` is then not used
  double temperature = 20.0;                        ///< temperature for the table, degrees Celsius
};

/// The speed v of the law, sqrt(slip^2 + eps^2), m/s.
/// @param slip_squared  |v_r|^2, m^2/s^2
template <class Scalar>
Scalar regularised_speed(const FrictionLaw& law, const Scalar& slip_squared)
{
  using std::sqrt;
  return sqrt(slip_squared + law.regularisation * law.regularisation);
}

/// Value table(v, p); complex arguments of complex steps are evaluated to first order in their
/// imaginary parts.
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

/// mu at the regularised speed v (m/s) and the pressure p (Pa).
template <class Scalar>
Scalar friction_coefficient(const FrictionLaw& law, const Scalar& v, const Scalar& p = Scalar(0.0))
{
  using std::exp;
  if (law.table) return law.kinetic * table_value(law, v, p);
  if (law.rise == 0.0) return Scalar(law.kinetic);
  return law.kinetic + law.rise * exp(-v / law.decay_speed);
}

/// The law with all coefficients multiplied by `factor`.
inline FrictionLaw scaled(FrictionLaw law, double factor)
{
  law.kinetic *= factor;
  law.rise *= factor;
  return law;
}

/// A spring with cubic stiffening, F = k x + k_3 x^3.
struct PadSpring {
  double linear;       ///< k, N/m
  double cubic = 0.0;  ///< k_3, N/m^3
};

/// Force of the spring at the compression x (m), N.
template <class Scalar>
Scalar force(const PadSpring& spring, const Scalar& x)
{
  return (spring.linear + spring.cubic * x * x) * x;
}

}  // namespace chladni::squeal
