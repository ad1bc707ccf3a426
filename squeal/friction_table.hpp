#pragma once

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
  int row = 0;                      ///< number of its row in the table of the scene, from 1
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

}  // namespace chladni::squeal
