#pragma once

#include "squeal/brake/contact.hpp"

namespace chladni::squeal {

/// Checks that the friction table covers the sliding equilibrium, because values and slopes outside
/// the table are not measured.
/// @param speed  rotation speed, rad/s
/// @throws chladni::Error naming the key, the value and the range of the table.
void require_in_table(const PadContact& pad, double speed);

}  // namespace chladni::squeal
