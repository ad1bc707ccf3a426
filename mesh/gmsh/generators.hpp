#pragma once

#include "mesh/flat_patches.hpp"
#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

/// The meshes of generators whose elements Gmsh makes, of options that were checked, without the
/// groups of rings and corners.
/// @throws chladni::Error when Gmsh fails.
namespace chladni::mesh {

Mesh unstructured_annulus(const AnnulusOptions& options);
Mesh unstructured_hat_disc(const HatDiscOptions& options);
Mesh unstructured_patch(const FourEdges& patch, const PatchOptions& options);

}  // namespace chladni::mesh
