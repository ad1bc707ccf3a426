#pragma once

#include <memory>

#include "sound/body_surface.hpp"
#include "sound/complex_factor.hpp"
#include "sound/wave.hpp"

namespace chladni::sound {

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
