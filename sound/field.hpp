#pragma once

#include <memory>

#include "sound/exterior.hpp"

namespace chladni::sound {

/// Sound fields of several vibrations of one body. In the meridian plane each column is the
/// amplitude of cos(n phi) or of sin(n phi).
struct Field {
  std::shared_ptr<const AirMesh> mesh;
  BodySurface surface;
  Wave wave;
  Eigen::MatrixXcd v_n;  ///< [n_points x n_fields] normal velocity of the surface, m/s
  Eigen::MatrixXcd p;    ///< [n_nodes x n_fields] pressure, Pa

  Eigen::Index n_fields() const { return p.cols(); }
};

/// Solves for all columns of v_n.
/// @param v_n  [n_points x n_fields] normal velocity out of the body, m/s
Field solve(Exterior& exterior, const Eigen::MatrixXcd& v_n);

/// Pressure at points in space, Pa: interpolated inside the mesh, and by kirchhoff_pressure from
/// the radius on where the absorbing shell begins.
/// @param x  [n x 3] m; in a meridian plane only r and z matter, because the result is the
///         amplitude
/// @return [n x n_fields]
/// @throws chladni::Error when a point is inside the body.
Eigen::MatrixXcd pressure_at(const Field& field, const Eigen::MatrixX3d& x);

/// Pressure by the Kirchhoff-Helmholtz integral p(x) = integral of p dG/dn - G dp/dn over the
/// body's surface with G = exp(-ikd) / (4 pi d). The formula is exact outside the body; its
/// quadrature is inaccurate close to the surface.
/// @param x  [n x 3] m
/// @return [n x n_fields] Pa
Eigen::MatrixXcd kirchhoff_pressure(const Field& field, const Eigen::MatrixX3d& x);

/// Far-field amplitude p R exp(ikR) for R to infinity.
/// @param directions  [n x 3] unit vectors from the origin
/// @return [n x n_fields] Pa m
Eigen::MatrixXcd far_field(const Field& field, const Eigen::MatrixX3d& directions);

/// Complex power 1/2 integral of conj(v_n) p over the whole body for all pairs of fields: [i, j] is
/// the work of the pressure of field i on the velocity of field j. The real parts of the diagonal
/// are the radiated powers, W. In the meridian plane the fields have the factor cos(n phi).
/// @return [n_fields x n_fields] W
Eigen::MatrixXcd complex_power(const Field& field);

/// Radiated power of each field from its far field: integral of |p|^2 / (2 rho c) over all
/// directions.
/// @return [n_fields] W
Eigen::VectorXd far_power(const Field& field);

}  // namespace chladni::sound
