#pragma once

#include "mbs_export/modal_body.hpp"
#include "sound/air_plan.hpp"
#include "sound/exterior.hpp"

/// The mode with three nodal diameters of the disc of Steinbrecher 2015, chapter 5, as a Kirchhoff
/// plate clamped at its hub, in closed form.
namespace chladni::sound::testing {

inline constexpr double disc_radius = 0.162;    // m
inline constexpr double hub_radius = 0.025;     // m
inline constexpr double disc_thickness = 0.02;  // m
inline constexpr double squeal_Hz = 1696.8532997475254;

/// Deflection U(r), which is 1 at the rim and 0 in the hub, and its derivative U'(r), 1/m.
double deflection(double r);
double slope(double r);

/// Normal velocity of the surface at points of a meridian for 1 m/s at the rim: U on the faces and
/// -zeta U' on the rim.
/// @param rim  factor on the motion of the rim, 0 or 1
/// @return [n_points x 1] m/s
Eigen::MatrixXcd disc_velocity(const BodySurface& surface, double rim);

/// Normal velocity of the surface at points in space, with the factor cos(3 phi) and the motion of
/// the rim, for 1 m/s at the rim.
/// @return [n_points x 1] m/s
Eigen::MatrixXcd disc_velocity_in_space(const BodySurface& surface);

/// A wave with three nodal diameters at the squeal frequency.
Wave squeal_wave();

/// A body with this pair of modes, a contact ring "track" at 0.13 m and a picture of 16 circles.
/// Its frequency is squeal_Hz.
mbs_export::ModalBody thesis_body();

inline constexpr double modal_mass = 1.60374675810;  // kg, for unit deflection of the rim

}  // namespace chladni::sound::testing
