#pragma once

#include "squeal/brake/contact.hpp"

namespace chladni::squeal {

/// Refuses a table of friction that does not reach the sliding equilibrium: a curve that goes on
/// beyond its last point would be a guess, and its slope another one.
/// @param speed  of rotation, rad/s
/// @throws chladni::Error naming the key, the value and the range of the table.
void require_in_table(const PadContact& pad, double speed);

}  // namespace chladni::squeal
