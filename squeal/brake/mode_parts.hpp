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
  std::vector<int> alone = {};    ///< 0-based, of the quasi-static ones those without a partner
  std::vector<int> still;         ///< 1-based, left out because they do not move the pads
  /// 1-based, left out because they move the rings with harmonic n / 2 of their n nodes
  std::vector<int> alternating;
};

/// Upper end of the frequency range for which a body with interface modes was made, rad/s: the
/// limit of its tolerance, or its highest other mode. Infinite for bodies without interface modes.
double range_of(const mbs_export::ModalBody& body);

/// The end of what a reduction knows of its modes, rad/s: the certified frequencies or, of a body
/// of all modes, half of the highest one; infinite where neither is known.
double end_of_known(const Disc& disc, const mbs_export::ModalBody& body);

/// Assigns a role to each mode.
/// @param disc  the disc of `body` with all modes
/// @throws chladni::Error as make_disc.
ModeParts mode_parts(const Disc& disc, const mbs_export::ModalBody& body, const ModeChoice& choice);

/// Checks that the nodes of each ring tell the modes of the disc from others. A mode of n nodal
/// diameters looks on N < 2 n + 1 nodes like one of |n - m N| diameters with another slope along
/// the ring, by which it is found where the nodes rotate; of N / 2 diameters the ring shows one
/// mode of a pair, which takes no part (`ModeParts::alternating`). Modes of interfaces and those
/// beyond the range do not count: they stand for many others.
/// @param disc  made of `body`
/// @throws chladni::Error with the mode, and the number of nodes that suffices for all of them.
void refuse_aliases(const Disc& disc, const mbs_export::ModalBody& body);

}  // namespace chladni::squeal
