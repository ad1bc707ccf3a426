#pragma once

#include <optional>

#include "sound/mesh_air.hpp"
#include "sound/wave.hpp"

namespace chladni::sound {

/// How the field is discretised.
enum class Method {
  automatic,  ///< by Fourier series where the outline is axisymmetric
  fourier,    ///< triangles in the meridian plane, one circumferential harmonic after the other
  tetrahedra
};

/// What the scene says about the air; what it leaves out follows from the frequency.
struct AirOptions {
  Medium medium = {};
  Method method = Method::automatic;
  std::optional<int> order = {};               ///< of the elements: 6 in the plane, 2 in space
  std::optional<double> element_size = {};     ///< m, largest
  std::optional<double> edge_size = {};        ///< m, at sharp edges
  std::optional<double> inner_radius = {};     ///< m, where the absorbing layer begins
  std::optional<double> layer_thickness = {};  ///< m
  std::optional<double> layer_strength = {};   ///< alpha; see AbsorbingLayer
};

/// A mesh for one frequency.
struct AirPlan {
  bool meridian;
  AirMeshOptions mesh;
  AbsorbingLayer layer;
};

/// Nodes per wavelength below which a mesh is refused.
inline constexpr double least_nodes_per_wavelength = 8.0;

/// @param omega       rad/s
/// @param half_space  the field is antisymmetric to z = 0
/// @throws chladni::Error when the elements are too large for the frequency, when the layer is too
///         thin or begins inside the body, or when the outline is not axisymmetric but has to be.
AirPlan plan_air(const Outline& outline, const AirOptions& options, double omega, bool half_space);

/// A plan with larger elements, whose error is more than twice that of the plan: the difference of
/// the two fields then tells the error of the finer one. It may be too coarse for plan_air.
AirPlan coarsened(AirPlan plan);

/// The mesh of a plan.
AirMesh air_around(const Outline& outline, const AirPlan& plan);

}  // namespace chladni::sound
