#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Meshes of the generators, with the groups that their options tell.
/// @throws chladni::Error when Gmsh fails or the lengths do not fit together.
Mesh annulus(const AnnulusOptions& options);
Mesh hat_disc(const HatDiscOptions& options);
Mesh pad(const PadOptions& options);
Mesh rectangle(const RectangleOptions& options);

/// Straight line of two-node elements.
/// @throws chladni::Error when its length vanishes or a point meets no node.
Mesh beam(const BeamMeshOptions& options);

/// Reads a .msh (formats 2.2 and 4.1, text or binary), or meshes a .geo or the surfaces of a .step.
/// Kept are surface elements, lines of the `line_groups`, and all groups; triangles and
/// quadrilaterals of order 1 to 4, serendipity elements completed.
/// @param options `file` is set; rings must be met by nodes of the mesh.
/// @throws chladni::Error when the file is missing, unreadable, cut off or of the wrong dimension,
///         and when nodes of unconnected elements stand at one place.
Mesh read_gmsh(const MeshOptions& options);

/// The mesh of the generator that is set or of the file, whatever its elements are like.
Mesh draft(const MeshOptions& options);

/// The mesh of the scene: a draft of which all elements can work.
/// @throws chladni::Error as check_usable.
Mesh generate(const MeshOptions& options);

}  // namespace chladni::mesh
