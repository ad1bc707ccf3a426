#pragma once

#include "sound/air_mesh.hpp"
#include "sound/outline.hpp"

namespace chladni::sound {

/// How the air around an outline is meshed.
struct AirMeshOptions {
  int order = 4;           ///< of the elements
  double element_size;     ///< m, largest
  double edge_size;        ///< m, at the sharp edges of the body
  double growth = 0.6;     ///< of the size per distance from there
  double inner_radius;     ///< m, of the sphere where the absorbing shell begins
  double shell_thickness;  ///< m
  bool half_space;         ///< only z > 0, for fields that are antisymmetric to z = 0
};

/// Triangles in the meridian plane of an axisymmetric outline.
/// @throws chladni::Error when Gmsh fails or the sphere does not hold the body.
AirMesh mesh_meridian(const Outline& outline, const AirMeshOptions& options);

/// Tetrahedra.
/// @throws chladni::Error likewise.
AirMesh mesh_space(const Outline& outline, const AirMeshOptions& options);

}  // namespace chladni::sound
