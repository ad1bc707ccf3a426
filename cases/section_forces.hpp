#pragma once

#include <string>
#include <vector>

#include "cases/fe_model.hpp"
#include "mbs_export/reduced_system.hpp"
#include "plate/assembly/assemble.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The section forces of beams and shells: for beams N, Q_y, Q_z, M_x, M_y, M_z (on the face with
/// normal +x, in the local axes) at the nodes of every line of each group, for shells those of
/// `shell_section_forces`, for solids the six stresses in the axes of the model. Kinds that no
/// component of the model can cause are left out.
/// @note   Collective, as `rows_of`.
/// @throws chladni::Error for a group without section, or without any of the chosen elements.
std::vector<mbs_export::ResultantModes> section_forces(const scene::ResultantChoice& choice,
                                                       const plate::Structure& structure,
                                                       const MeshedDofs& fe, const RowsOf& rows_of);

}  // namespace chladni::cases
