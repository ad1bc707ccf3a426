#pragma once

#include <array>

#include "squeal/brake/contact.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Contact places above and below a ring in the middle surface of a plate.
/// @param thickness  of the plate, m
/// @param radius     of the ring, m
std::array<PadFace, 2> faces_of_plate(double thickness, double radius);

/// Contact data of one pad pair of the scene.
/// @param faces  places of the upper and of the lower pad
PadContact pad_contact(const SquealOptions& options, const PadPair& pad,
                       const std::array<PadFace, 2>& faces);

}  // namespace chladni::squeal
