#pragma once

#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Angle and speed of the disc, and preload of the pads.
struct Turn {
  double angle;          ///< rad
  double speed;          ///< rad/s
  double preload = 1.0;  ///< factor on the preload of all pads
};

/// Angle, speed and preload at time t (s) by the programs of a transient. Speed and preload are
/// linear between the points of their programs and constant before the first and after the last
/// point; without a program they are constant.
Turn turn_at(const TransientCase& run, double t);

/// Factor on the preload at time t (s): linear between the points of the preload program, constant
/// before the first and after the last point; 1 without a program.
double preload_at(const TransientCase& run, double t);

}  // namespace chladni::squeal
