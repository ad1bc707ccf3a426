#pragma once

#include <functional>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// The mesh that was kept in the folder `options.cache` for these options, or the mesh that `make`
/// makes, which is kept there. A kept mesh is found by a digest of the options, of the bytes of the
/// file and of this program, so that no change of any of them finds an old mesh. Damaged files are
/// made anew. What other files decide on is not kept: a .geo that reads some, a deck, a file that
/// its owner trusts.
/// @return the mesh, with a note that says where it came from, or why it was not kept
Mesh kept_mesh(const MeshOptions& options, const std::function<Mesh()>& make);

}  // namespace chladni::mesh
