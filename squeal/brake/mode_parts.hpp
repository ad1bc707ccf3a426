#pragma once

#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The roles of a body's modes in a study.
struct ModeParts {
  std::vector<int> dynamic;       ///< 0-based, with stiffness and inertia
  std::vector<int> quasi_static;  ///< 0-based, with their compliance only
  std::vector<int> still;         ///< 1-based, left out because they do not move the pads
  /// 1-based, left out because they move the rings with harmonic n / 2 of their n nodes
  std::vector<int> alternating;
};

/// Upper end of the frequency range for which a body with interface modes was made, rad/s: the
/// limit of its tolerance, or its highest other mode. Infinite for bodies without interface modes.
double range_of(const mbs_export::ModalBody& body);

/// Assigns a role to each mode.
/// @param disc  the disc of `body` with all modes
/// @throws chladni::Error as make_disc.
ModeParts mode_parts(const Disc& disc, const mbs_export::ModalBody& body, const ModeChoice& choice);

}  // namespace chladni::squeal
