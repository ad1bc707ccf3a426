#pragma once

#include "sound/air_mesh.hpp"
#include "sound/outline.hpp"

namespace chladni::sound {

/// Options of a mesh of the air around an outline.
struct AirMeshOptions {
  int order = 4;           ///< order of the elements
  double element_size;     ///< largest element size, m
  double edge_size;        ///< element size at the sharp edges of the body, m
  double growth = 0.6;     ///< increase of the size per distance from the edges
  double inner_radius;     ///< radius of the sphere where the absorbing shell begins, m
  double shell_thickness;  ///< m
  bool half_space;         ///< mesh only z > 0, for fields antisymmetric about z = 0
};

/// Triangles in the meridian plane of an axisymmetric outline.
/// @throws chladni::Error when Gmsh fails or the sphere does not contain the body.
AirMesh mesh_meridian(const Outline& outline, const AirMeshOptions& options);

/// Tetrahedra around an outline.
/// @throws chladni::Error when Gmsh fails or the sphere does not contain the body.
AirMesh mesh_space(const Outline& outline, const AirMeshOptions& options);

}  // namespace chladni::sound
