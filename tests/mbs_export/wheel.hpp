#pragma once

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export::test {

constexpr int wheel_rim_nodes = 12;
constexpr double wheel_radius = 0.1;       // m
constexpr double wheel_height = 0.02;      // m, of the rim above the hub
constexpr double rim_node_mass = 0.1;      // kg
constexpr double hub_mass = 0.5;           // kg
constexpr double rim_node_inertia = 2e-5;  // kg m^2, about any axis
constexpr double hub_inertia = 4e-4;       // kg m^2, about any axis

/// A free wheel in space: a rim of 12 nodes about the z axis, a hub at the origin, linear
/// Timoshenko beams with one integration point (gamma = u_b - u_a - theta x l, kappa = theta_b -
/// theta_a) as rim and spokes, of equal stiffness for all directions normal to z. All DOFs are
/// masters; sets "rim" and "hub"; with the mass integrals of its nodes. By the symmetry of the rim
/// its modes come in pairs.
ReducedSystem wheel();

/// The wheel with mass integrals as if its nodes had no inertia of their own: sums over the nodes,
/// as other programs make them, are then exact.
ReducedSystem wheel_of_points();

}  // namespace chladni::mbs_export::test
