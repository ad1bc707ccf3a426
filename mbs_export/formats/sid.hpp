#pragma once

#include <string>

#include "mbs_export/formats/floating_body.hpp"

namespace chladni::mbs_export::formats {

/// The dialect of SID files, which differ in three things: the order of the indices of m1 (row,
/// mode, column or row, column, mode), of the squares of the angular velocity in Oe (xx, yy, zz,
/// xy, yz, xz or xx, yy, zz, xy, xz, yz), and J as six rows or as a matrix.
enum class SidDialect { simpack, welib };

/// The order of the columns of Gr and Ge: the three axes of the first mode, then those of the next;
/// or all modes about x, then about y, then about z. Public readers and files use either order.
enum class SidGyroscopic { by_mode, by_axis };

struct SidOptions {
  SidDialect dialect = SidDialect::simpack;
  SidGyroscopic gyroscopic = SidGyroscopic::by_mode;
};

/// A body as Standard Input Data (*.SID_FEM) in the frame of the mesh: shapes at the attachment
/// nodes, the inertia and its change with the deformation to first order, gyroscopic and
/// centrifugal matrices. The geometric stiffening of the body (stiffening.hpp) is in the first
/// order of Oe, Cr and Ct; ksigma, the force of a stress without motion, is zero. Gr has no first
/// order.
/// @throws chladni::Error when the body has no mass integrals or no elastic mode.
std::string sid_fem(const FloatingBody& floating, const SidOptions& options);

}  // namespace chladni::mbs_export::formats
