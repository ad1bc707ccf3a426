#include "cli/mesh_scene.hpp"

#include "mesh/generate.hpp"

namespace chladni::cli {

mesh::Mesh mesh_scene(const Scene& scene)
{
  return mesh::generate(scene.mesh);
}

}  // namespace chladni::cli
