#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Quadrilateral-dominated mesh of a plane annular disc, by Gmsh.
/// @throws chladni::Error when Gmsh fails or the radii are not ordered.
Mesh annulus(const AnnulusOptions& options);

/// Reads a .msh (formats 2.2 and 4.1) or meshes a .geo. Only elements of dimension 2 and the
/// physical groups are kept. Triangles and quadrilaterals of order 1 to 3.
/// @param options `file` is set; rings must be met by nodes of the mesh.
/// @throws chladni::Error when the file is missing, unreadable or has no surface elements.
Mesh read_gmsh(const MeshOptions& options);

/// The mesh of the scene: `annulus` or `read_gmsh`.
Mesh generate(const MeshOptions& options);

}  // namespace chladni::mesh
