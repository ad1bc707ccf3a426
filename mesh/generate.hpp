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

/// Reads a .msh (formats 2.2 and 4.1) or meshes a .geo. Kept are elements of dimension 2, those of
/// the `line_groups`, and all physical groups. Triangles and quadrilaterals of order 2 and 3.
/// @param options `file` is set; rings must be met by nodes of the mesh.
/// @throws chladni::Error when the file is missing, unreadable or has no such elements.
Mesh read_gmsh(const MeshOptions& options);

/// The mesh of the scene: of the generator that is set, or of the file.
Mesh generate(const MeshOptions& options);

}  // namespace chladni::mesh
