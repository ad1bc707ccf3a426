#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/petsc.hpp"

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
