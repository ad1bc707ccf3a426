#pragma once

#include <variant>

#include "squeal/assembly_options.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/friction.hpp"
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

/// A pad and a disc, each a mass on a spring and a damper that moves along the other one; the
/// normal force is constant. Both are counted from the sliding equilibrium:
///   m_1 x_1'' + d_1 x_1' + k_1 x_1 =   mu(v) N_0 v_r / v - mu(V) N_0
///   m_2 x_2'' + d_2 x_2' + k_2 x_2 = -(mu(v) N_0 v_r / v - mu(V) N_0),     v_r = V - x_1' + x_2'
/// Small motions have the damping matrix [d_1, 0; 0, d_2] + N_0 mu'(V) [1, -1; -1, 1].
/// Source: the kind of model of Shin, Brennan, Oh, Harris, J. Sound Vib. 254 (2002) 837.
struct TwoMasses {
  double m_1;      ///< of the pad, kg
  double k_1;      ///< N/m
  double d_1;      ///< N s/m
  double m_2;      ///< of the disc, kg
  double k_2;      ///< N/m
  double d_2;      ///< N s/m
  double preload;  ///< N_0, N
  double radius;   ///< V = radius * speed is the velocity of the surface, m
  FrictionLaw friction;
};

/// A rigid block on springs that stands with a straight foot on a moving surface: x along the
/// motion of the surface, y into it; phi presses the end of the foot at larger x into the surface.
/// The two ends of the foot, at x + s with s = b -+ l / 2 and at the depth h below the centre of
/// mass, carry half of N_0 and of k_c each:
///   m x'' + d_x x' + k_x x = sum of T - T at rest
///   m y'' + d_y y' + k_y y = -sum of N - N_0 / 2
///   J phi'' + d_phi phi' + k_phi phi = -sum of s (N - N_0 / 2) + h (T - T at rest)
///   N = N_0 / 2 + k_c / 2 (y + s phi),   v_r = V - x' + h phi',   T = mu(v) N v_r / v
/// Friction couples tilting and normal motion without symmetry where b is not zero.
/// Source: the kind of model of Brommundt, ZAMM 75 (1995) 811, whose friction rises with the speed.
struct TiltingBlock {
  double mass;               ///< m, kg
  double inertia;            ///< J about the centre of mass, kg m^2
  double k_x;                ///< along the surface, N/m
  double k_y;                ///< normal to it, N/m
  double k_phi;              ///< against tilting, N m
  double d_x;                ///< N s/m
  double d_y;                ///< N s/m
  double d_phi;              ///< N m s
  double height;             ///< h of the centre of mass above the surface, m
  double foot_length;        ///< l, m
  double foot_offset;        ///< b of the middle of the foot, m; > 0 where the surface goes
  double contact_stiffness;  ///< k_c of the whole foot, N/m
  double preload;            ///< N_0 of the whole foot, N
  double radius;             ///< V = radius * speed is the velocity of the surface, m
  FrictionLaw friction;
  ContactLaw law = ContactLaw::unilateral;
};

/// A study of a model without a mesh of its own: a rigid disc, an oscillator, or an assembly of
/// bodies made by other scenes.
struct ModelOptions {
  std::variant<RigidDiscStudy, Oscillator, AssemblyOptions, TwoMasses, TiltingBlock> model;
  StudyOptions study;
};

}  // namespace chladni::squeal
