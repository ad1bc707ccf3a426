#pragma once

#include "plate/assembly/inertia_integrals.hpp"

namespace chladni::plate {

/// A load on the mass that is linear in the positions, dm (c_0 + x c_x + y c_y + z c_z), given by
/// the factors (c_0, c_x, c_y, c_z) of the columns of MassMoments::displacement.
using MassLoad = Eigen::Vector<double, 12>;

/// K_sigma of the whole model by the stress of its static displacements under a load on its mass:
/// v^T K_sigma v / 2 is the energy of a motion v by stress and load, in addition to that of K.
/// Included are
/// - membrane forces of shells and axial forces of beams (elements/geometric_stiffness.hpp);
/// - forces of elements at arms that turn: rigid couplings, links and offsets;
/// - the load on lumped masses.
/// Not included are moments and transverse forces in elements, springs, and the change of the load
/// by the rotation of a section (rotary inertia).
/// @param u     static displacements of the DOFs, rows as K; m, rad
/// @param load  the load that causes u, beside the forces of supports; if it accelerates the body,
///              with its inertia
/// @return AIJ as System::K
/// @note   Collective on the communicator of the model.
petsc::Matrix geometric_stiffness(const MassModel& model, Vec u, const MassLoad& load);

}  // namespace chladni::plate
