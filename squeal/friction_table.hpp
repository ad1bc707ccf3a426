#pragma once

#include <vector>

namespace chladni::squeal {

/// mu over the speed of sliding at one pressure and one temperature: piecewise cubic with one
/// slope at each point, limited so that it is monotone where the points are; constant beyond them.
/// Source: F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300.
struct FrictionCurve {
  std::vector<double> speeds;       ///< m/s, ascending; one for a constant
  std::vector<double> mu;           ///< as many
  std::vector<double> slopes = {};  ///< d mu / d v, s/m; of `friction_curve`
  int row = 0;                      ///< number of its row in the table of the scene, from 1
};

FrictionCurve friction_curve(std::vector<double> speeds, std::vector<double> mu);

/// Measured friction: a curve over the speed at each pressure of each temperature. Between
/// pressures a cubic with the slopes of parabolas through three of them, between temperatures
/// linear; constant beyond the first and the last.
struct FrictionTable {
  std::vector<double> temperatures = {};  ///< degrees Celsius, ascending; empty: mu has none
  std::vector<double> pressures = {};     ///< Pa, ascending; empty: mu does not depend on it
  std::vector<FrictionCurve> curves;      ///< of each temperature in turn, one at each pressure
};

/// Ranges in which all curves of a table have points.
struct FrictionRange {
  double speed_from, speed_to;              ///< m/s; 0 to infinity for constants
  double pressure_from, pressure_to;        ///< Pa; likewise
  double temperature_from, temperature_to;  ///< degrees Celsius; -infinity to infinity without any
};
FrictionRange range_of(const FrictionTable& table);

/// A place in the table.
struct FrictionPlace {
  double speed, pressure;
};

/// mu and its derivatives.
struct FrictionValue {
  double mu, by_speed, by_pressure;  ///< 1, s/m, 1/Pa
};

FrictionValue friction_at(const FrictionTable& table, double temperature,
                          const FrictionPlace& place);

}  // namespace chladni::squeal
