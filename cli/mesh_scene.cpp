#include "cli/mesh_scene.hpp"

#include "cli/broadcast_mesh.hpp"
#include "cli/petsc_session.hpp"
#include "mesh/generate.hpp"

namespace chladni::cli {

mesh::Mesh mesh_scene(const Scene& scene)
{
  return mesh::generate(scene.mesh);
}

mesh::Mesh mesh_on_all_ranks(const Scene& scene)
{
  mesh::Mesh mesh;
  on_first_rank([&] { mesh = mesh_scene(scene); });
  return broadcast(mesh);
}

}  // namespace chladni::cli
