#pragma once

#include <variant>

#include "squeal/assembly_options.hpp"
#include "squeal/friction.hpp"
#include "squeal/squeal_options.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// A rigid disc on a spherical joint at its centre with rotational springs and dampers, between two
/// pads on the vertical axis through (0, -r_0).
struct RigidDisc {
  double Theta;      ///< moment of inertia about a diameter, kg m^2
  double Phi;        ///< moment of inertia about the axis, kg m^2
  double k_t;        ///< stiffness of the rotational springs, N m
  double d_t;        ///< damping of the rotational dampers, N m s
  double radius;     ///< radius r_0 of the pads, m
  double thickness;  ///< distance h of the two contact planes, m
  PadSpring spring;  ///< spring of each pad
  double damping;    ///< damping d of each pad, N s/m
  double preload;    ///< preload N_0 of each pad, N
  FrictionLaw friction;
  ContactLaw law = ContactLaw::unilateral;
};

/// The moment that drives the disc about the inertial vertical.
enum class Drive {
  speed,  ///< the moment that keeps the spin constant
  moment  ///< the constant moment 2 mu r_0 N_0
};

/// Equations of the rigid disc for a simulation.
enum class RigidEquations {
  nonlinear,  ///< finite angles, and loss of contact by the contact law
  linear      ///< the linearisation at rest
};

/// A rigid disc with its drive and equations.
struct RigidDiscStudy {
  RigidDisc disc;
  Drive drive = Drive::speed;
  RigidEquations equations = RigidEquations::nonlinear;
};

/// The minimal model with squeal: a mass pressed on a moving surface and held by springs that
/// couple its motion x along the surface and y normal to it. Both are measured from the sliding
/// equilibrium; the contact stiffness k_c makes the normal force depend on y:
///   m x'' + d_x x' + k_x x + k_xy y             = mu(v) N v_r / v - mu(V) N_0
///   m y'' + d_y y' + k_xy x + k_y y + (N - N_0) = 0,     N = N_0 + k_c y,   v_r = V - x'
/// so that the stiffness matrix [k_x, k_xy - mu k_c; k_xy, k_y + k_c] is not symmetric.
/// Source: the kind of model of Popp, Rudolph, Kroeger, Lindner, VDI-Berichte 1736 (2002).
struct Oscillator {
  double mass;               ///< m, kg
  double k_x;                ///< stiffness along the surface, N/m
  double k_y;                ///< stiffness normal to the surface, N/m
  double k_xy;               ///< coupling stiffness, N/m; k_xy^2 < k_x k_y
  double d_x;                ///< damping along the surface, N s/m
  double d_y;                ///< damping normal to the surface, N s/m
  double contact_stiffness;  ///< k_c, N/m
  double preload;            ///< N_0, N
  double radius;             ///< radius of the surface, whose velocity is V = radius * speed, m
  FrictionLaw friction;
  ContactLaw law = ContactLaw::unilateral;
};

/// A study of a model without a mesh of its own: a rigid disc, an oscillator, or an assembly of
/// bodies made by other scenes.
struct ModelOptions {
  std::variant<RigidDiscStudy, Oscillator, AssemblyOptions> model;
  StudyOptions study;
};

}  // namespace chladni::squeal
