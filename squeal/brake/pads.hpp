#pragma once

#include <array>

#include "squeal/brake/contact.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The faces of a plate of this thickness (m) above and below a ring of its middle surface (radius,
/// m).
std::array<PadFace, 2> faces_of_plate(double thickness, double radius);

/// The contact of one pad pair of the scene with these faces, of the upper pad and of the lower
/// one.
PadContact pad_contact(const SquealOptions& options, const PadPair& pad,
                       const std::array<PadFace, 2>& faces);

}  // namespace chladni::squeal
