#pragma once

#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Where the disc stands, how fast it turns, and how hard the pads press.
struct Turn {
  double angle;          ///< rad
  double speed;          ///< rad/s
  double preload = 1.0;  ///< factor of the preload of all pads
};

/// The turn at time t (s) under the programs of a transient: linear between the points of its
/// speeds and preloads, constant before the first and after the last; constant throughout without a
/// program.
Turn turn_at(const TransientCase& run, double t);

/// The factor of the preload at time t (s): linear between the points of the preload program,
/// constant before the first and after the last; 1 without a program.
double preload_at(const TransientCase& run, double t);

}  // namespace chladni::squeal
