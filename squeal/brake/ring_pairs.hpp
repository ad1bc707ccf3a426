#pragma once

#include <array>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The rings under the upper and above the lower pad of a pair: one for both, or two.
struct RingPair {
  std::array<std::size_t, 2> rings;  ///< indices among those of the disc
  std::array<PadFace, 2> faces;
};

/// The rings of the study, on which pads without a grid and the centres of plates lie.
/// @param rings  of the disc, those of the study first
/// @throws chladni::Error when two rings of one pair lie at one height.
RingPair study_pair(const SquealOptions& options, const std::vector<RingPlace>& rings);

/// Those on which the grid of a pad lies.
/// @param pad  its number, for messages
/// @throws chladni::Error when the disc has no ring of a name, and as above.
std::vector<RingPair> ring_pairs(const SquealOptions& options, const PadGrid& grid,
                                 const std::vector<RingPlace>& rings, std::size_t pad);

}  // namespace chladni::squeal
