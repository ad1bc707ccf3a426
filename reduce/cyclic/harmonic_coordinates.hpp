#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <optional>
#include <string>
#include <vector>

#include "common/petsc.hpp"
#include "reduce/cyclic/sector.hpp"
#include "reduce/reduction.hpp"

namespace chladni::cyclic {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A master of a harmonic: the amplitude of a component of a node on the axis, or of a harmonic of
/// a ring. The harmonics of a ring are numbered 1, cos(phi), sin(phi), cos(2 phi), ...; they are
/// orthonormal columns over its nodes, with radial, tangential and axial components and the
/// rotations about these directions.
struct Master {
  int ring;        ///< index in SectorDofs::rings; -1 for a node on the axis
  int place;       ///< number of the harmonic; for a node its index in SectorDofs::axis
  int component;   ///< 0 .. 5
  int coordinate;  ///< row of the harmonic's matrices
};

/// The motion that a coordinate stands for.
struct CoordinateOrigin {
  int block;      ///< block of the node; -1 for a harmonic of a ring
  int place;      ///< number of that harmonic
  int component;  ///< 0 .. 5
  bool of_y;      ///< for a node: in y, else in x
};

/// The motions of the whole body that belong to one harmonic, in real coordinates c. Sector j moves
/// as R^j (cos(j mu) x - sin(j mu) y) with x = X c, y = Y c and R the turn by one sector, so that
/// the whole body has
///   u^T K u = c^T [weight (X^T K_1 X + Y^T K_1 Y)] c
/// with K_1 of the sector; weight is count / 2, or count without y.
struct HarmonicCoordinates {
  int order;
  int count;
  double weight;
  SparseRows X, Y;              ///< [n of the sector x n]; Y is zero if there is one phase
  std::vector<Master> masters;  ///< nodes on the axis, then rings, each by harmonic and component
  /// The motion a quarter of a period later, J: (x, y) -> (-y, x). Row i of J c is `sign[i]`
  /// c[`partner[i]`]. It does not change energies, so each eigenvalue is double.
  std::vector<int> partner;
  std::vector<double> sign;
  std::vector<CoordinateOrigin> origins;
  /// `symmetric_motions` if there are a mirror and two phases; else empty
  SparseRows symmetric = {};

  int n() const { return static_cast<int>(X.cols()); }
  bool has_one_phase() const { return cyclic::has_one_phase(order, count); }
};

/// The motion of DOFs of the sector in the two phases of HarmonicCoordinates.
struct SectorMotion {
  Eigen::MatrixXd x, y;  ///< [n_dofs x n]
};

/// The coordinates of a harmonic of a sector.
/// Source: Thomas, Int. J. Numer. Methods Eng. 14 (1979) 81.
HarmonicCoordinates harmonic_coordinates(const SectorDofs& sector, int order);

/// A form of the whole body in the coordinates, weight (X^T A X + Y^T A Y), symmetric to the last
/// bit. Entries below 1e-14 of their diagonals are round-off and dropped.
/// @param A  symmetric
SparseRows harmonic_form(const SparseRows& A, const HarmonicCoordinates& c);

/// A J.
SparseRows times_quarter_turn(const SparseRows& A, const HarmonicCoordinates& c);

enum class Symmetry { symmetric, none };

/// A copy of an AIJ matrix that lies on one rank.
SparseRows sparse_rows(Mat A);

/// A matrix that each rank of `comm` has whole, as AIJ with the rows distributed over `comm`.
/// @note   Collective on `comm`.
petsc::Matrix as_matrix(const SparseRows& A, Symmetry symmetry, MPI_Comm comm = PETSC_COMM_SELF);

/// The symmetric half of a harmonic whose sector has a mirror, as coordinates X B and Y B with the
/// symmetric motions B. A master represents all masters that the mirror mixes with it.
HarmonicCoordinates symmetric_half(const HarmonicCoordinates& c);

/// The masters of a harmonic as sums of those of its symmetric half and of J of these.
struct MasterHalves {
  Eigen::MatrixXd now;    ///< [n_masters x n_masters / 2]
  Eigen::MatrixXd later;  ///< of J of them, a quarter of a period later
};
/// The two parts of the masters of a harmonic.
MasterHalves master_halves(const HarmonicCoordinates& c, const HarmonicCoordinates& half);

/// A form of the half in the masters and modes of the whole: its masters, then for each mode of the
/// half this mode and the same mode a quarter of a period later.
/// @param A  [n_masters / 2 + n_modes squared]
Eigen::MatrixXd unfolded_form(const Eigen::MatrixXd& A, const MasterHalves& masters);

/// The rows of a transformation in the masters and modes of the whole, from those of the half.
/// @param half  [k x n_masters / 2 + n_modes] of the symmetric motions
SectorMotion unfolded_motion(const SectorMotion& half, const MasterHalves& masters);

/// The certificate of the whole: each eigenvalue of the half appears twice.
reduce::Certificate unfolded_certificate(const reduce::Certificate& half);

/// The mirror plane of a sector whose cut edges are straight and are mirror images of each other.
/// @param positions  [n_blocks x 3] m, of the nodes of the blocks
/// @param forms      matrices of the sector; empty ones are ignored
/// @return absent if positions or a form are not symmetric to it
std::optional<Mirror> find_mirror(const SectorDofs& sector, const Eigen::MatrixX3d& positions,
                                  const std::vector<const SparseRows*>& forms);

/// The motions that the mirror leaves unchanged: half of those of a harmonic with two phases. Each
/// eigenspace is double because of J; one direction of it is symmetric, and J of it is the other.
/// @param sector  with its mirror
/// @return [n x n / 2] orthonormal, with a few entries in each column
SparseRows symmetric_motions(const HarmonicCoordinates& c, const SectorDofs& sector);

}  // namespace chladni::cyclic

/// Sectors whose matrices are distributed over the ranks and of which only the matching rows are
/// known. `harmonic_coordinates` also knows the nodes, rings and mirror of a sector, on one rank.

namespace chladni::cyclic {

/// The rows of a sector that match those of the next one: u_high = R u_low of the first sector
/// equals u_low of the second one, in the axes of the first.
struct MatchingRows {
  int count;  ///< number of sectors, at least 2
  /// Global rows, on all ranks, in blocks of the rows of R. A row in both belongs to a node that
  /// all sectors share.
  std::vector<PetscInt> low, high;
  /// Orthogonal, R^count = I: the turn of the components of a block by one sector.
  Eigen::MatrixXd R;
};

/// Checks the matching rows of a sector.
/// @param n_rows  number of rows of the sector
/// @throws chladni::Error naming the rows when the sets do not match or overlap, or R is no turn by
///         one sector.
void check_matching_rows(const MatchingRows& rows, PetscInt n_rows);

/// The real coordinates c of a harmonic: sector j moves as R^j (cos(j mu) x - sin(j mu) y) with x =
/// X c, y = Y c. Rows keep their order; each has a coordinate in x, then one in y. Rows of `high`
/// have none.
class SectorCoordinates {
 public:
  /// @param rows   checked by `check_matching_rows`
  /// @param order  0 .. count / 2
  SectorCoordinates(MatchingRows rows, int order);

  int order() const { return order_; }
  int count() const { return rows_.count; }
  bool has_one_phase() const;
  /// The factor of the form of the whole body, c^T [weight (X^T A X + Y^T A Y)] c.
  double weight() const { return count() * (has_one_phase() ? 1.0 : 0.5); }

  /// The first coordinate of a row: the number of coordinates of all rows before it.
  PetscInt first(PetscInt row) const;
  /// The number of coordinates of a row: 0 if it follows other rows, 1 if it moves in x alone, else
  /// 2.
  PetscInt n_of(PetscInt row) const { return first(row + 1) - first(row); }
  PetscInt row_of(PetscInt coordinate) const;
  /// The name of a coordinate for messages, as "row 17 of K, in y".
  std::string name_of(PetscInt coordinate) const;
  /// The rows of a shared node that move together with this one, itself among them, where not all
  /// of them have coordinates. Which of them have is a choice of pivots, so that an interface or a
  /// support names all of them or none. Empty where each row that moves has a coordinate of its
  /// own, as about an axis of coordinates.
  std::vector<PetscInt> alike(PetscInt row) const;
  /// The row of `low` that a row of `high` follows; else -1.
  PetscInt followed_by(PetscInt row) const;

  /// The matrix X; Y likewise.
  /// @param like  a matrix of the sector, whose row layout X has
  /// @return [n x n_coordinates] AIJ
  /// @note   Collective on the communicator of `like`.
  petsc::Matrix X(Mat like) const;
  petsc::Matrix Y(Mat like) const;

 private:
  struct Phase;
  petsc::Matrix phase(Mat like, const Phase& phase) const;

  MatchingRows rows_;
  int order_;
  std::vector<PetscInt> without_;  ///< rows without a coordinate, ascending
  std::vector<PetscInt> single_;   ///< rows of shared nodes with one coordinate, ascending
  /// x of a shared node from its kept components
  Eigen::MatrixXd E_;
  std::vector<int> kept_;  ///< these components, ascending
};

/// The coordinates of a harmonic of a distributed sector, with the matrices X and Y.
struct SectorHarmonic {
  SectorCoordinates coordinates;
  petsc::Matrix X, Y;  ///< Y is empty if there is one phase
};

/// The coordinates of a harmonic.
/// @note   Collective on the communicator of `like`, as is `harmonic_operator`.
SectorHarmonic sector_harmonic(MatchingRows rows, int order, Mat like);

/// weight (X^T A X + Y^T A Y), AIJ.
petsc::Matrix harmonic_operator(Mat A, const SectorHarmonic& harmonic);

}  // namespace chladni::cyclic
