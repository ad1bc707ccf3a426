#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace chladni::squeal {

/// What one number of the brake does.
struct GradientRow {
  std::string key;   ///< of [squeal], or "frequency of ..." of a mode or pair of the disc
  std::string unit;  ///< of its value
  double value;
  /// d Omega_c / d value, rad/s over the unit; absent without a critical speed
  std::optional<double> critical_speed = {};
  Eigen::VectorXd growth = {};  ///< [n_motions] d Re(lambda) / d value, 1/s over the unit
};

/// A motion whose growth is differentiated.
struct GradientMotion {
  double growth;        ///< 1/s
  double frequency_Hz;  ///< in the frame of the pads
};

/// Derivatives of the critical speed, and of growth rates at one speed, by every number of the
/// brake; see stability/gradients.hpp. Rows by falling effect of a change by one per cent.
struct Gradients {
  std::optional<double> critical_speed;         ///< rad/s; absent where there is none
  std::optional<double> critical_frequency_Hz;  ///< of the oscillation there
  std::optional<double> speed;                  ///< of the growth rates, rad/s
  std::vector<GradientMotion> motions;  ///< at it: the least stable, then all others that grow
  std::vector<GradientRow> rows;
};

/// What a change of the value by one per cent does to the critical speed or, without one, to the
/// largest growth rate, without sign; rad/s or 1/s.
double effect_of_one_per_cent(const Gradients& gradients, const GradientRow& row);

}  // namespace chladni::squeal
