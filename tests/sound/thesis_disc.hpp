#pragma once

#include "sound/body_surface.hpp"
#include "sound/wave.hpp"

/// The disc of Steinbrecher 2015, chapter 5, as a Kirchhoff plate clamped at its hub: the mode with
/// three nodal diameters, in closed form.
namespace chladni::sound::testing {

inline constexpr double disc_radius = 0.162;    // m
inline constexpr double hub_radius = 0.025;     // m
inline constexpr double disc_thickness = 0.02;  // m
inline constexpr double squeal_Hz = 1696.8532997475254;

/// U(r), 1 at the rim, and its derivative; zero in the hub.
double deflection(double r);
double slope(double r);

/// Velocity 1 m/s at the rim: U on the faces, and -zeta U' on the rim.
/// @param rim  factor of the motion of the rim, 0 or 1
Eigen::MatrixXcd disc_velocity(const BodySurface& surface, double rim);

Wave squeal_wave();

}  // namespace chladni::sound::testing
