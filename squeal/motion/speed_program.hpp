#pragma once

#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Where the disc stands and how fast it turns.
struct Turn {
  double angle;  ///< rad
  double speed;  ///< rad/s
};

/// The turn at time t (s) under the speeds of a transient: linear between the points of its speed
/// program, constant before the first and after the last; constant throughout without a program.
Turn turn_at(const TransientCase& run, double t);

}  // namespace chladni::squeal
