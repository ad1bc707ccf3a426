#pragma once

#include <memory>

#include "sound/exterior.hpp"

namespace chladni::sound {

/// Sound fields of several vibrations of one body. In the meridian plane each is the amplitude of
/// cos(n phi), or of sin(n phi).
struct Field {
  std::shared_ptr<const AirMesh> mesh;
  BodySurface surface;
  Wave wave;
  Eigen::MatrixXcd v_n;  ///< [n_points x n_fields] normal velocity at the surface, m/s
  Eigen::MatrixXcd p;    ///< [n_nodes x n_fields] Pa

  Eigen::Index n_fields() const { return p.cols(); }
};

/// Solves for all columns of v_n.
Field solve(Exterior& exterior, const Eigen::MatrixXcd& v_n);

/// Pressures at points of space, Pa: interpolated in the mesh, by the integral of Kirchhoff and
/// Helmholtz over the body where the absorbing shell begins.
/// @param x  [n x 3] m; of a meridian plane only r and z matter, since the result is the amplitude
/// @return [n x n_fields]
/// @throws chladni::Error when a point is inside the body.
Eigen::MatrixXcd pressure_at(const Field& field, const Eigen::MatrixX3d& x);

/// The integral of Kirchhoff and Helmholtz: p(x) = integral of p dG/dn - G dp/dn over the body with
/// G = exp(-ikd) / (4 pi d). Exact outside the body, but not close to it.
Eigen::MatrixXcd kirchhoff_pressure(const Field& field, const Eigen::MatrixX3d& x);

/// p R exp(ikR) far away, Pa m.
/// @param directions  [n x 3] unit vectors from the origin
Eigen::MatrixXcd far_field(const Field& field, const Eigen::MatrixX3d& directions);

/// 1/2 integral of conj(v_n) p over the whole body for all pairs of fields: [i, j] is the work of
/// the pressure of field i on the velocity of field j. The real part of the diagonal is the
/// radiated power, W. In the meridian plane for cos(n phi).
Eigen::MatrixXcd complex_power(const Field& field);

/// Radiated power of each field from its far field: integral of |p|^2 / (2 rho c) over all
/// directions, W.
Eigen::VectorXd far_power(const Field& field);

}  // namespace chladni::sound
