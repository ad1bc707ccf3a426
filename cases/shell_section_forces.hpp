#pragma once

#include "cases/chosen_elements.hpp"
#include "cases/node_rows.hpp"
#include "mbs_export/reduced_system.hpp"
#include "plate/assembly/assemble.hpp"

namespace chladni::cases {

/// Membrane forces N_x, N_y, N_xy, moments M_x, M_y, M_xy and shear forces Q_x, Q_y per length, at
/// the Gauss points where they are most accurate (p x p for order p). Axes: e_z is the director,
/// e_x the global x axis in the tangent plane (y where the shell faces x). Kinds that no component
/// of the model can cause are left out.
/// @note   Collective, as `rows_of`.
mbs_export::ResultantModes shell_section_forces(const Chosen& chosen,
                                                const plate::ShellSection& section,
                                                const MeshedDofs& fe, const RowsOf& rows_of);

/// The number of these points in a shell element; 0 for a line.
Eigen::Index points_of_shell(const mesh::ElementBlock& block);

/// Removes the kinds that are zero for all coordinates.
void drop_silent_kinds(mbs_export::ResultantModes& forces);

}  // namespace chladni::cases
