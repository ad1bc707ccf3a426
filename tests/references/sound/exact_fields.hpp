#pragma once

#include <complex>

#include "sound/exterior.hpp"
#include "sound/outline.hpp"

namespace chladni::sound::testing {

/// The outgoing multipole p = h_l^(2)(kR) P_l^n(cos theta) cos(n phi), in Pa: an exact sound field
/// around any body that contains the origin.
struct Multipole {
  int l;
  int n;
};

/// Pressure at (r, z) in the plane phi = 0, Pa.
std::complex<double> pressure(const Multipole& multipole, const Wave& wave, double r, double z);

/// Normal velocity of the surface that generates this field, v_n = i / (omega rho) dp/dn, at points
/// of a meridian for phi = 0 or of a surface in space.
/// @return [n_points x 1] m/s
Eigen::MatrixXcd normal_velocity(const Multipole& multipole, const Wave& wave,
                                 const BodySurface& surface);

/// Pressure at a point of space, with the factor cos(n phi), Pa.
std::complex<double> pressure(const Multipole& multipole, const Wave& wave,
                              const Eigen::Vector3d& x);

/// Largest error of the nodal pressures inside the absorbing shell's inner radius, relative to the
/// largest exact pressure there.
double field_error(const AirMesh& mesh, const Wave& wave, const Eigen::VectorXcd& p,
                   const Multipole& exact);

/// Root mean square error of those nodal pressures, relative to the exact ones.
double mean_field_error(const AirMesh& mesh, const Wave& wave, const Eigen::VectorXcd& p,
                        const Multipole& exact);

/// A ball around the origin.
inline Outline sphere(double radius)
{
  return {.quadrilaterals = {}, .balls = {{.z = 0.0, .radius = radius}}};
}

/// A disc without a hole, with its middle plane at z = 0.
Outline solid_disc(double radius, double thickness);

}  // namespace chladni::sound::testing
