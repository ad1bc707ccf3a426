#pragma once

#include "mbs_export/modal_body.hpp"
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

/// The same in space, with cos(3 phi).
Eigen::MatrixXcd disc_velocity_in_space(const BodySurface& surface);

Wave squeal_wave();

/// A body of the pair of modes, with a contact ring "track" at 0.13 m and a picture of 16 circles.
/// Its frequency is that of the squeal.
mbs_export::ModalBody thesis_body();

inline constexpr double modal_mass = 1.60374675810;  // kg, of unit deflection of the rim

}  // namespace chladni::sound::testing
