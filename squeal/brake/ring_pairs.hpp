#pragma once

#include <array>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The rings under the upper pad and above the lower pad of a pair: two rings, or one twice.
struct RingPair {
  std::array<std::size_t, 2> rings;  ///< indices of the disc's rings, upper first
  std::array<PadFace, 2> faces;
};

/// The rings of the study, used by pads without a grid and by the centres of plates.
/// @param rings  rings of the disc, those of the study first
/// @throws chladni::Error when the two rings lie at the same height.
RingPair study_pair(const SquealOptions& options, const std::vector<RingPlace>& rings);

/// The ring pairs of a pad's grid.
/// @param pad  index of the pad, for messages
/// @throws chladni::Error when the disc does not have a ring, or the two rings of a pair lie at the
///         same height.
std::vector<RingPair> ring_pairs(const SquealOptions& options, const PadGrid& grid,
                                 const std::vector<RingPlace>& rings, std::size_t pad);

}  // namespace chladni::squeal
