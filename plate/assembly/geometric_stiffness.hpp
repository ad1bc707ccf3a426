#pragma once

#include "plate/assembly/inertia_integrals.hpp"

namespace chladni::plate {

/// A load on the mass that is linear in the positions, dm (c_0 + x c_x + y c_y + z c_z): the
/// factors (c_0, c_x, c_y, c_z) of the columns of MassMoments::displacement.
using MassLoad = Eigen::Vector<double, 12>;

/// K_sigma of the whole model by the stress of its static displacements under a load on its mass:
/// v^T K_sigma v / 2 is what the load and the stress do on v beyond K. It counts
/// - membrane forces of shells and axial forces of beams (elements/geometric_stiffness.hpp);
/// - what elements pull at arms that turn: rigid couplings, links and offsets;
/// - the load on lumped masses.
/// It leaves out moments and transverse forces in elements, springs, and the load's change with the
/// turn of a section (rotary inertia).
/// @param u     static displacements of the DOFs, as the rows of K; m, rad
/// @param load  that they are the answer to, beside the forces of supports; with the
///              inertia of a body that it accelerates
/// @return AIJ as System::K
/// @note   Collective on the communicator of the model.
petsc::Matrix geometric_stiffness(const MassModel& model, Vec u, const MassLoad& load);

}  // namespace chladni::plate
