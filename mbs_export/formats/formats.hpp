#pragma once

#include <Eigen/Core>

#include <set>
#include <string>
#include <vector>

#include "mbs_export/formats/floating_body.hpp"
#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"

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

/// A number for each attachment node: its own, if that is in 1 .. largest and no earlier node has
/// it, else the smallest number that no node has.
/// @throws chladni::Error when there are more nodes than numbers.
std::vector<int> unique_node_numbers(const std::vector<AttachmentNode>& nodes, int largest);

}  // namespace chladni::mbs_export::formats

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

/// The form of a matrix in Nastran.
enum class MatrixForm { rectangular = 2, symmetric = 6 };

/// A real double-precision matrix in the formatted, non-sparse OUTPUT4 layout. Its 17 significant
/// digits restore the same numbers. Entries below 1e-99 become zero.
/// @param name  up to 8 letters
/// @throws chladni::Error when an entry is not finite or above 1e99.
std::string op4_matrix(const std::string& name, const Eigen::MatrixXd& A, MatrixForm form);

/// A matrix of an OUTPUT4 file.
struct Op4Matrix {
  std::string name;  ///< in capitals
  Eigen::MatrixXd A;
};

/// Reads real matrices of an OUTPUT4 file: formatted or binary (either byte order), dense or
/// sparse, with or without BIGMAT.
/// @param wanted  their names; others are passed over
/// @throws chladni::Error naming the matrix, and line or byte, of what cannot be read.
std::vector<Op4Matrix> read_op4(const std::string& bytes, const std::set<std::string>& wanted);

/// Writes a body as the dictionary of Exudyn's ObjectFFRFreducedOrderInterface, in the HDF5 layout
/// that its LoadDictFromHDF5 reads. Nodes are the attachment nodes, then those of the picture,
/// whose triangles are the surface. Its products of shapes are the mass integrals of the FE model,
/// which cannot be computed from the mid-surface nodes of shells.
/// @throws chladni::Error when the body has no mass integrals or no elastic mode, or the file
///         cannot be written.
void write_exudyn(const std::string& path, const FloatingBody& floating);

/// The matrices of a reduced system as dense symmetric Matrix Market arrays: lower triangles with
/// 17 digits.
struct MatrixMarket {
  std::string K, M, C;  ///< C is empty without dampers
  std::string H;        ///< structural damping, empty without loss factors
  /// CSV with a line for each row of the matrices: its coordinate and place.
  std::string coordinates;
};

MatrixMarket matrix_market(const ReducedSystem& reduced);

}  // namespace chladni::mbs_export::formats
