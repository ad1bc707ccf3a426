#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

/// Derivatives by one parameter of the brake.
struct GradientRow {
  /// Key of [squeal], or "frequency of ..." for a mode or pair of the disc.
  std::string key;
  std::string unit;  ///< unit of `value`
  double value;
  /// d Omega_c / d value, rad/s per unit of value; absent without a critical speed.
  std::optional<double> critical_speed = {};
  Eigen::VectorXd growth = {};  ///< [n_motions] d Re(lambda) / d value, 1/s per unit of value
};

/// A motion whose growth rate is differentiated.
struct GradientMotion {
  double growth;        ///< 1/s
  double frequency_Hz;  ///< in the frame of the pads
};

/// Derivatives of the critical speed, and of growth rates at one speed, by every parameter of the
/// brake; see stability/gradients.hpp. Rows are sorted by descending effect of a change by one per
/// cent.
struct Gradients {
  std::optional<double> critical_speed;  ///< rad/s; absent when there is none
  /// Frequency of the oscillation at the critical speed.
  std::optional<double> critical_frequency_Hz;
  std::optional<double> speed;  ///< speed of the growth rates, rad/s
  /// Motions at that speed: the least stable one, then all others that grow.
  std::vector<GradientMotion> motions;
  std::vector<GradientRow> rows;
};

/// A change by which numbers are compared: one per cent of the value, or for places and angles of
/// parts, whose values depend on the origin, 0.1 mm and 0.1 degrees.
struct UsualChange {
  double value;      ///< in the unit of the row
  const char* name;  ///< "1 %"
};
UsualChange usual_change(const GradientRow& row);

/// Effect of the usual change of a value on the critical speed or, without one, on the largest
/// growth rate; absolute value, rad/s or 1/s.
double effect_of_usual_change(const Gradients& gradients, const GradientRow& row);

}  // namespace chladni::squeal
