#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "cyclic/sector_dofs.hpp"

namespace chladni::cyclic {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// What a master is the amplitude of: a component of the node on the axis, or of a harmonic of a
/// ring. Harmonics are counted 1, cos(phi), sin(phi), cos(2 phi), ..., of orthonormal columns over
/// the nodes of the ring; their components are radial, tangential, axial and the rotations about
/// these.
struct Master {
  int ring;        ///< index in SectorDofs::rings; -1 for a node on the axis
  int place;       ///< of the harmonic; of a node the index in SectorDofs::axis
  int component;   ///< 0 .. 5
  int coordinate;  ///< row of the harmonic's matrices
};

/// What a coordinate moves.
struct CoordinateOrigin {
  int block;      ///< of the node whose component it is; -1 for a harmonic of a ring
  int place;      ///< of that harmonic
  int component;  ///< 0 .. 5
  bool of_y;      ///< of a node: in y
};

/// The motions of the whole body that belong to one harmonic, in real coordinates c. Sector j moves
/// as R^j (cos(j mu) x - sin(j mu) y) with x = X c, y = Y c and R the turn by one sector, so that
///   u^T K u = c^T [weight (X^T K_1 X + Y^T K_1 Y)] c
/// of the whole body, with K_1 that of the sector: weight is count / 2, or count without y.
struct HarmonicCoordinates {
  int order;
  int count;
  double weight;
  SparseRows X, Y;              ///< [n of the sector x n]; Y is zero where there is one phase
  std::vector<Master> masters;  ///< nodes on the axis, then rings, each by harmonic and component
  /// The motion a quarter of a period later, (x, y) -> (-y, x): row i of J c is
  /// `sign[i]` c[`partner[i]`]. It leaves the energies as they are: each eigenvalue is double.
  std::vector<int> partner;
  std::vector<double> sign;
  std::vector<CoordinateOrigin> origins;
  SparseRows symmetric = {};  ///< `symmetric_motions` where there are a mirror and two phases

  int n() const { return static_cast<int>(X.cols()); }
  bool has_one_phase() const { return cyclic::has_one_phase(order, count); }
};

/// How the sector's DOFs move, in the two phases of HarmonicCoordinates.
struct SectorMotion {
  Eigen::MatrixXd x, y;  ///< [n_dofs x n]
};

/// Source: Thomas, Int. J. Numer. Methods Eng. 14 (1979) 81.
HarmonicCoordinates harmonic_coordinates(const SectorDofs& sector, int order);

/// A form of the whole body in the coordinates, weight (X^T A X + Y^T A Y), symmetric to the last
/// bit. What is below 1e-14 of its diagonals is round-off and no entry.
/// @param A  symmetric
SparseRows harmonic_form(const SparseRows& A, const HarmonicCoordinates& c);

/// A J
SparseRows times_quarter_turn(const SparseRows& A, const HarmonicCoordinates& c);

}  // namespace chladni::cyclic
