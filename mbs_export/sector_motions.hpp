#pragma once

#include <Eigen/Core>
#include <vector>

namespace chladni::mbs_export {

/// Which circumferential harmonic of a body of n_sectors equal sectors each coordinate belongs to.
/// One of order n moves a circle about the axis in the harmonics n, n_sectors - n, n_sectors + n, 2
/// n_sectors - n, ... alone, and has no mass or stiffness in common with those of another order.
struct SectorHarmonics {
  int n_sectors;
  std::vector<int> order;  ///< of each coordinate, 0 to n_sectors / 2; -1: more than one
};

/// Those of other coordinates, of each by its kinetic energy: T^T M T = I.
/// @param T  [n x m]
SectorHarmonics in_coordinates(const SectorHarmonics& harmonics, const Eigen::MatrixXd& M,
                               const Eigen::MatrixXd& T);

/// Displacements of the nodes of all sectors of a body of equal sectors, from those of one: sector
/// j moves as cos(j mu) x - sin(j mu) y, mu = 2 pi order / n_sectors, turned with the sector about
/// the z axis.
struct SectorMotions {
  struct Harmonic {
    int order;
    Eigen::MatrixXd x, y;               ///< [3 n x k] rows x, y, z of the nodes of the first sector
    std::vector<Eigen::Index> columns;  ///< [k] of the whole body's coordinates
  };
  int n_sectors = 0;
  Eigen::Index n_coordinates = 0;  ///< of the whole body
  std::vector<Harmonic> harmonics;
  /// [n_coordinates squared] where the whole body has other coordinates than those that the columns
  /// number: these are T times them. Else empty.
  Eigen::MatrixXd T = {};

  Eigen::Index rows_of_sector() const { return harmonics.empty() ? 0 : harmonics[0].x.rows(); }
};

/// The rows of all sectors times T, of which none is made without it.
/// @param T  [n_coordinates x m]
/// @return [3 n n_sectors x m]
Eigen::MatrixXd in_coordinates(const SectorMotions& motions, const Eigen::MatrixXd& T);

}  // namespace chladni::mbs_export
