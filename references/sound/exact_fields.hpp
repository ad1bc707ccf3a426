#pragma once

#include <complex>

#include "sound/exterior.hpp"
#include "sound/outline.hpp"

namespace chladni::sound::testing {

/// The outgoing multipole p = h_l^(2)(kR) P_l^n(cos theta) cos(n phi), in Pa: an exact field around
/// any body that holds the origin.
struct Multipole {
  int l;
  int n;
};

/// At (r, z) of the plane phi = 0.
std::complex<double> pressure(const Multipole& multipole, const Wave& wave, double r, double z);

/// The normal velocity at points of the surface that makes this field, for phi = 0 in a meridian
/// plane: v_n = i / (omega rho) dp/dn.
Eigen::MatrixXcd normal_velocity(const Multipole& multipole, const Wave& wave,
                                 const BodySurface& surface);

/// The same at a point of space, with cos(n phi).
std::complex<double> pressure(const Multipole& multipole, const Wave& wave,
                              const Eigen::Vector3d& x);

/// Largest difference of the nodal pressures from the exact ones before the absorbing shell, over
/// the largest exact one.
double field_error(const AirMesh& mesh, const Wave& wave, const Eigen::VectorXcd& p,
                   const Multipole& exact);

/// The same of all nodes together, in the mean square.
double mean_field_error(const AirMesh& mesh, const Wave& wave, const Eigen::VectorXcd& p,
                        const Multipole& exact);

inline Outline sphere(double radius)
{
  return {.quadrilaterals = {}, .balls = {{.z = 0.0, .radius = radius}}};
}

/// A disc without a hole, its middle plane at z = 0.
Outline solid_disc(double radius, double thickness);

}  // namespace chladni::sound::testing
