#pragma once

#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"

/// A reduced system for Nastran: bulk data (DMIG) or an external superelement (OP4, ASM, PCH). The
/// body is free, in the basic coordinate system and in SI.
namespace chladni::mbs_export::formats {

/// The numbers of the DOFs in Nastran. A grid keeps the number of its node if that is unique and in
/// 1 .. 89,999,999; fixed-interface modes become scalar points numbered after the last grid.
struct NastranNumbers {
  std::vector<int> grids;  ///< number of each attachment node
  int first_spoint;
};
NastranNumbers nastran_numbers(const ReducedSystem& reduced);

/// Bulk data: GRID (with the components that are no masters constrained), SPOINT, and the matrices
/// KRED, MRED, BRED as DMIG for K2GG, M2GG, B2GG, with the ten digits that a field of DMIG holds.
/// @throws chladni::Error when C is not symmetric, or an entry is too large for a field.
std::string nastran_dmig(const ReducedSystem& reduced);

/// The three files of an external superelement.
struct NastranSuperelement {
  std::string op4;       ///< KAA, MAA, BAA and what else the assembly run reads, with all digits
  std::string assembly;  ///< for the main bulk data: SEBULK, SECONCT, GRID, SPOINT
  std::string superelement;  ///< for the end: BEGIN SUPER, EXTRN, GRID, ASET, QSET1, SPOINT
};

/// The files of an external superelement.
/// @param number  of the superelement, and of the Fortran unit of its OP4 file, 1 .. 9999
/// @throws chladni::Error as `nastran_dmig`.
NastranSuperelement nastran_superelement(const ReducedSystem& reduced, int number);

}  // namespace chladni::mbs_export::formats
