#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// An annular disc of rows and columns, without the groups of its rings.
Mesh structured_annulus(const AnnulusOptions& options);

/// A disc with hat of rows and columns, without the groups of its rings.
Mesh structured_hat_disc(const HatDiscOptions& options);

}  // namespace chladni::mesh
