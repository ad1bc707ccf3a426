#pragma once

#include <string>

#include "mbs_export/formats/floating_body.hpp"

namespace chladni::mbs_export::formats {

/// The version of MBDyn that reads the file. MBDyn 1.7 stops at record groups beyond 13; the
/// development version (2023 and later) reads the inertia invariants 3, 4, 8, 5 and 9 from groups
/// 14 to 18.
enum class MbdynVersion { v1_7, develop };

/// A body for MBDyn's joint "modal" (*.fem), in the frame of the mesh. The inertia is in group 12
/// and never in group 11, which the reader replaces by lumped masses. The joint must not move the
/// origin ("origin position", "origin node"): the reader would shift the nodes and the inertia, but
/// not the invariants. The invariants 8, 5 and 9 (inertia that changes with deformation) are
/// written if the body has mass integrals.
/// @throws chladni::Error when MBDyn 1.7 cannot express the coupling of a held body with its frame.
std::string mbdyn_fem(const FloatingBody& floating, MbdynVersion version);

}  // namespace chladni::mbs_export::formats
