#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Annular disc of rows and columns, without its rings' groups.
Mesh structured_annulus(const AnnulusOptions& options);

/// Disc with hat of rows and columns, without its rings' groups.
Mesh structured_hat_disc(const HatDiscOptions& options);

}  // namespace chladni::mesh
