#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"
#include "mesh/sweep.hpp"

/// What rectangles and pads have in common.

namespace chladni::mesh {

/// A plane surface with four edges: two at the ends of the profile, two at the ends of the path.
struct FourEdges {
  std::string surface;
  std::array<std::string, 4> edges;  ///< start and end of the profile, start and end of the path
  double start, end;                 ///< of the profile, m
  double length;                     ///< of the path, m
  std::function<std::array<double, 3>(const Station&, double t)> position;
  bool round = false;  ///< edges at the ends of the profile are arcs about the origin
};

struct PatchOptions {
  double element_size;
  int element_order;
  Pattern pattern;
  std::optional<double> edge_row;
};

FourEdges edges_of(const RectangleOptions& options);
FourEdges edges_of(const PadOptions& options);

PatchOptions patch_of(const auto& options)
{
  return {options.element_size, options.element_order, options.pattern, options.edge_row};
}

/// The meshes of the generators, with the groups that their options list.
/// @throws chladni::Error when Gmsh fails or the lengths do not fit together.
Mesh annulus(const AnnulusOptions& options);
Mesh hat_disc(const HatDiscOptions& options);
Mesh pad(const PadOptions& options);
Mesh rectangle(const RectangleOptions& options);

/// A straight line of two-node elements.
/// @throws chladni::Error when its length vanishes or a point meets no node.
Mesh beam(const BeamMeshOptions& options);

/// Reads a .msh (formats 2.2 and 4.1, text or binary), or meshes a .geo or the surfaces of a .step.
/// The mesh has the surface elements, the lines of `line_groups`, and all groups. Triangles and
/// quadrilaterals have order 1 to 4; serendipity elements are completed.
/// @param options  `file` is set; nodes of the mesh must stand at the places of the rings
/// @throws chladni::Error when the file is missing, unreadable, cut off or of the wrong dimension,
///         and when nodes of unconnected elements stand at one place.
Mesh read_gmsh(const MeshOptions& options);

/// The mesh of the generator or file of the options, without a check of its elements.
Mesh draft(const MeshOptions& options);

/// The mesh of the scene, with elements that are all usable.
/// @throws chladni::Error as `draft` and `check_usable`.
Mesh generate(const MeshOptions& options);

}  // namespace chladni::mesh
