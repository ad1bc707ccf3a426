#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/petsc.hpp"

/// Sectors whose matrices are distributed over the ranks, and of which nothing is known but the
/// rows that match. `harmonic_coordinates` knows nodes, rings and the mirror of a sector besides,
/// on one rank.
namespace chladni::cyclic {

/// Rows of a sector at which the next one goes on: u_high = R u_low of the first sector is where
/// u_low of the second one is.
struct MatchingRows {
  int count;                        ///< of sectors, at least 2
  std::vector<PetscInt> low, high;  ///< global, on all ranks; blocks of rows of R. The same rows in
                                    ///< both are those of a node that all sectors share
  Eigen::MatrixXd R;                ///< orthogonal, R^count = I: the turn of a block's components
};

/// @param n_rows  of the sector
/// @throws chladni::Error naming the rows, when the sets do not match or overlap, or R is no turn
/// by
///         a sector.
void check_matching_rows(const MatchingRows& rows, PetscInt n_rows);

/// The real coordinates c of a harmonic: sector j moves as R^j (cos(j mu) x - sin(j mu) y) with
/// x = X c, y = Y c. Rows keep their order; each has x, then y. Rows of `high` have none.
class SectorCoordinates {
 public:
  /// @param rows   that `check_matching_rows` has let pass
  /// @param order  0 .. count / 2
  SectorCoordinates(MatchingRows rows, int order);

  int order() const { return order_; }
  int count() const { return rows_.count; }
  bool has_one_phase() const;
  /// c^T [weight (X^T A X + Y^T A Y)] c is the form of the whole body.
  double weight() const { return count() * (has_one_phase() ? 1.0 : 0.5); }

  /// The number of coordinates of all rows before this one: where its own begin.
  PetscInt first(PetscInt row) const;
  /// 0 where it follows other rows, 1 in x alone, 2 in x and y.
  PetscInt n_of(PetscInt row) const { return first(row + 1) - first(row); }
  PetscInt row_of(PetscInt coordinate) const;
  /// "row 17 of K, in y"
  std::string name_of(PetscInt coordinate) const;
  /// The row of `low` that a row of `high` follows, or -1.
  PetscInt followed_by(PetscInt row) const;

  /// @param like  a matrix of the sector, whose rows X has
  /// @return [n x n_coordinates] AIJ
  /// @note   Collective on the communicator of `like`.
  petsc::Matrix X(Mat like) const;
  petsc::Matrix Y(Mat like) const;

 private:
  struct Phase;
  petsc::Matrix phase(Mat like, const Phase& phase) const;

  MatchingRows rows_;
  int order_;
  std::vector<PetscInt> without_;  ///< rows with no coordinate, ascending
  std::vector<PetscInt> single_;   ///< rows of shared nodes with one coordinate, ascending
  Eigen::MatrixXd E_;              ///< of a shared node: its x, from those of the kept components
  std::vector<int> kept_;          ///< these components, ascending
};

/// The coordinates of a distributed sector with its transformation.
struct SectorHarmonic {
  SectorCoordinates coordinates;
  petsc::Matrix X, Y;  ///< Y is empty where there is one phase
};

/// @note   Collective on the communicator of `like`, as all below.
SectorHarmonic sector_harmonic(MatchingRows rows, int order, Mat like);

/// weight (X^T A X + Y^T A Y), AIJ
petsc::Matrix harmonic_operator(Mat A, const SectorHarmonic& harmonic);

}  // namespace chladni::cyclic
