#pragma once

#include <optional>

#include "sound/air_mesh.hpp"

namespace chladni::sound {

/// Properties of the air.
struct Medium {
  double density = 1.2;           ///< kg/m^3
  double speed_of_sound = 343.0;  ///< m/s
};

/// The wave Re(p exp(i omega t)), in the meridian plane with p ~ cos(n phi); n is not used in
/// space.
struct Wave {
  Medium medium;
  double omega;  ///< rad/s
  int n = 0;     ///< circumferential harmonic

  double k() const { return omega / medium.speed_of_sound; }  ///< wave number, 1/m
};

/// Perfectly matched layer: in the shell R > R_p of thickness d the coordinates become complex, x
/// [1 - i alpha xi^(m + 1) / (k R)] with xi = (R - R_p) / d, so that an outgoing wave decays by
/// exp(-alpha) to the outer end.
struct AbsorbingLayer {
  double alpha = 10.0;
  int m = 1;
};

/// Discretisation of the sound field.
enum class Method {
  automatic,  ///< Fourier series when the outline is axisymmetric, else tetrahedra
  fourier,    ///< triangles in the meridian plane, one system for each circumferential harmonic
  tetrahedra
};

/// The options of the scene for the air; those left open follow from the frequency.
struct AirOptions {
  Medium medium = {};
  Method method = Method::automatic;
  std::optional<int> order = {};  ///< order of the elements; default 6 in the plane, 2 in space
  std::optional<double> element_size = {};     ///< largest element size, m
  std::optional<double> edge_size = {};        ///< element size at sharp edges, m
  std::optional<double> inner_radius = {};     ///< inner radius of the absorbing layer, m
  std::optional<double> layer_thickness = {};  ///< thickness of the absorbing layer, m
  std::optional<double> layer_strength = {};   ///< alpha of AbsorbingLayer
};

/// Mesh options and absorbing layer for one frequency.
struct AirPlan {
  bool meridian;  ///< triangles in the meridian plane, else tetrahedra
  AirMeshOptions mesh;
  AbsorbingLayer layer;
};

/// The least number of nodes per wavelength; plan_air refuses coarser meshes.
inline constexpr double least_nodes_per_wavelength = 8.0;

/// Chooses mesh and absorbing layer for one frequency.
/// @param omega       rad/s
/// @param half_space  whether the field is antisymmetric about z = 0
/// @throws chladni::Error when the elements are too large for the frequency, when the layer is too
///         thin or begins inside the body, or when Method::fourier is asked for an outline with
///         holes.
AirPlan plan_air(const Outline& outline, const AirOptions& options, double omega, bool half_space);

/// The plan with larger elements, whose error is more than twice as large: the difference of the
/// two fields then estimates the error of the finer one. The result may be too coarse for plan_air.
AirPlan coarsened(AirPlan plan);

/// Meshes the air by a plan.
/// @throws chladni::Error as mesh_meridian and mesh_space.
AirMesh air_around(const Outline& outline, const AirPlan& plan);

}  // namespace chladni::sound
