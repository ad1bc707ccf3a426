#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "cyclic/sector_dofs.hpp"

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

}  // namespace chladni::cyclic
