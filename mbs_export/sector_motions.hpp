#pragma once

#include <Eigen/Core>
#include <vector>

namespace chladni::mbs_export {

/// The circumferential harmonic to which each coordinate of a body of n_sectors equal sectors
/// belongs. A coordinate of order n moves a circle about the axis only in the harmonics n,
/// n_sectors - n, n_sectors + n, 2 n_sectors - n, ..., and shares no mass or stiffness with those
/// of another order.
struct SectorHarmonics {
  int n_sectors;
  std::vector<int> order;  ///< of each coordinate, 0 to n_sectors / 2; -1: several
};

/// The harmonics of other coordinates, each by its kinetic energy; T^T M T = I.
/// @param T  [n x m]
SectorHarmonics in_coordinates(const SectorHarmonics& harmonics, const Eigen::MatrixXd& M,
                               const Eigen::MatrixXd& T);

/// The displacements of the nodes of all sectors of a body of equal sectors, given by those of one:
/// sector j moves as cos(j mu) x - sin(j mu) y, mu = 2 pi order / n_sectors, turned with the sector
/// about the z axis.
struct SectorMotions {
  struct Harmonic {
    int order;
    /// [3 n x k] rows x, y, z of the nodes of the first sector
    Eigen::MatrixXd x, y;
    std::vector<Eigen::Index> columns;  ///< [k] indices of the whole body's coordinates
  };
  int n_sectors = 0;
  Eigen::Index n_coordinates = 0;  ///< of the whole body
  std::vector<Harmonic> harmonics;
  /// [n_coordinates squared] Set if the coordinates of the whole body are others than those that
  /// `columns` numbers, which are T times them. Else empty.
  Eigen::MatrixXd T = {};

  Eigen::Index rows_of_sector() const { return harmonics.empty() ? 0 : harmonics[0].x.rows(); }
};

/// The rows of all sectors times T, computed without forming the rows themselves.
/// @param T  [n_coordinates x m]
/// @return [3 n n_sectors x m]
Eigen::MatrixXd in_coordinates(const SectorMotions& motions, const Eigen::MatrixXd& T);

}  // namespace chladni::mbs_export
