#pragma once

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export::test {

/// The smallest system in which an order can go wrong: nodes -1 (which Nastran cannot name) and 7,
/// masters z and ry of the first and z of the second with the second node first, two
/// fixed-interface modes, no entry like another.
ReducedSystem two_nodes();

}  // namespace chladni::mbs_export::test
