#pragma once

#include <string>
#include <vector>

#include "cli/node_rows.hpp"
#include "cli/reduce_steps.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::cli {

/// The section forces N, Q_y, Q_z, M_x, M_y, M_z (on the face with normal +x, in the local axes) at
/// both ends of every beam of each group; kinds that no component of the model can cause are left
/// out.
/// @note   Collective, as rows_of.
/// @throws chladni::Error for a group without beams.
std::vector<mbs_export::ResultantModes> section_forces(const std::vector<std::string>& groups,
                                                       const std::vector<plate::BeamSection>& beams,
                                                       const FeModel& fe, const RowsOf& rows_of);

}  // namespace chladni::cli
