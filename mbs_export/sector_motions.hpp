#pragma once

#include <Eigen/Core>
#include <vector>

namespace chladni::mbs_export {

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

  Eigen::Index rows_of_sector() const { return harmonics.empty() ? 0 : harmonics[0].x.rows(); }
};

/// The rows of one sector, [3 n x n_coordinates].
Eigen::MatrixXd rows_of_sector(const SectorMotions& motions, int sector);

/// The rows of all sectors times T, of which none is made without it.
/// @param T  [n_coordinates x m]
/// @return [3 n n_sectors x m]
Eigen::MatrixXd in_coordinates(const SectorMotions& motions, const Eigen::MatrixXd& T);

}  // namespace chladni::mbs_export
