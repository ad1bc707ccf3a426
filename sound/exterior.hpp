#pragma once

#include <zmumps_c.h>
#include <Eigen/SparseCore>

#include <complex>
#include <memory>
#include <vector>

#include "sound/air_mesh.hpp"
#include "sound/air_plan.hpp"

namespace chladni::sound {

/// Integration points on the surface of the body; in a half space only those with z > 0.
struct BodySurface {
  Eigen::MatrixXd x;       ///< [n_points x 2 or 3] m
  Eigen::MatrixXd normal;  ///< [n_points x 2 or 3] unit vectors into the air
  Eigen::VectorXd weight;  ///< [n_points] area, m^2; for a meridian arc length times r, m^2 / rad
  /// [n_points x n_nodes] interpolates nodal values at the points.
  Eigen::SparseMatrix<double, Eigen::RowMajor> trace;

  Eigen::Index n_points() const { return weight.size(); }
};

/// The integration points on the body's surface of a mesh.
BodySurface body_surface(const AirMesh& mesh);

/// Factor from the sum over the integration points to the integral over the whole surface, for the
/// square of a field with cos(n phi).
double surface_measure(const AirMesh& mesh, int n);

/// LDL^T factor of a complex symmetric matrix, computed by MUMPS on this process alone with an
/// ordering by METIS.
/// @note MPI must be initialised.
class ComplexFactor {
 public:
  using Sparse = Eigen::SparseMatrix<std::complex<double>>;

  /// Factorises a matrix.
  /// @param lower  its lower triangle
  /// @throws chladni::Error when the factorisation fails.
  explicit ComplexFactor(const Sparse& lower);
  ~ComplexFactor();
  ComplexFactor(const ComplexFactor&) = delete;
  ComplexFactor& operator=(const ComplexFactor&) = delete;

  /// Solves for any number of right-hand sides, one per column.
  /// @throws chladni::Error when MUMPS fails.
  Eigen::MatrixXcd solve(Eigen::MatrixXcd right_hand_sides);
  double memory_MiB() const { return mumps_.infog[21]; }  ///< INFOG(22)

 private:
  void call(int job, const char* what);

  ZMUMPS_STRUC_C mumps_{};
  std::vector<int> rows_, columns_, order_;
  std::vector<std::complex<double>> values_;
};

/// Solver for the sound field around a vibrating body in free space: Delta p + k^2 p = 0 in the
/// air, dp/dn = -i omega rho v_n on the body with the normal into the air, and outgoing waves.
class Exterior {
 public:
  /// Assembles and factorises the system of one frequency and circumferential harmonic.
  /// @note MPI must be initialised.
  /// @throws chladni::Error when the factorisation fails.
  Exterior(std::shared_ptr<const AirMesh> mesh, const Wave& wave, const AbsorbingLayer& layer = {});

  /// Pressure at the nodes for each column of normal velocities.
  /// @param v_n  [n_points of the surface x n] normal velocity out of the body, m/s
  /// @return [n_nodes x n] Pa
  Eigen::MatrixXcd pressure(const Eigen::MatrixXcd& v_n);

  const AirMesh& mesh() const { return *mesh_; }
  std::shared_ptr<const AirMesh> shared_mesh() const { return mesh_; }
  const BodySurface& surface() const { return surface_; }
  const Wave& wave() const { return wave_; }
  int n_unknowns() const { return static_cast<int>(free_.size()); }
  double memory_MiB() const { return factor_->memory_MiB(); }

 private:
  std::shared_ptr<const AirMesh> mesh_;
  Wave wave_;
  BodySurface surface_;
  std::vector<int> free_;  ///< nodes with unknown pressure; it is zero at the others
  std::unique_ptr<ComplexFactor> factor_;
};

/// Node positions with the absorbing shell stretched into the complex plane.
/// @param k  wave number, 1/m
/// @return [n_nodes x dimension] m
Eigen::MatrixXcd stretched_positions(const AirMesh& mesh, double k, const AbsorbingLayer& layer);

}  // namespace chladni::sound
