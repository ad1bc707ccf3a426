#pragma once

#include <Eigen/Core>

namespace chladni::squeal {

/// The largest of equally spaced samples of one period, refined by a parabola unless it is a
/// plateau.
double peak(const Eigen::VectorXd& x);

/// Derivative of the peak of x + s dx by s.
double peak_change(const Eigen::VectorXd& x, const Eigen::VectorXd& dx);

/// Amplitudes of a pad over a period.
struct PadAmplitudes {
  double velocity;      ///< largest, m/s
  double displacement;  ///< half the stroke, m
};

/// The amplitudes of samples of a displacement (m) and its velocity (m/s) over a period.
PadAmplitudes pad_amplitudes(const Eigen::VectorXd& z, const Eigen::VectorXd& z_dot);

}  // namespace chladni::squeal
