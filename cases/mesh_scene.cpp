#include "cases/mesh_scene.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "cases/broadcast_mesh.hpp"
#include "cases/ranks.hpp"
#include "mesh/generators.hpp"

namespace chladni::cases {

mesh::Mesh mesh_scene(const scene::Scene& scene)
{
  return mesh::generate(scene.mesh);
}

void check_groups(const scene::Scene& scene, const mesh::Mesh& mesh)
{
  std::vector<std::string> names;
  for (const mesh::Group& group : mesh.groups) names.push_back(group.name);
  scene::check_groups(scene, names);
}

mesh::Mesh mesh_on_all_ranks(const scene::Scene& scene)
{
  mesh::Mesh mesh;
  on_first_rank([&] {
    mesh = mesh_scene(scene);
    for (const std::string& note : mesh.notes) fmt::print(stderr, "note: {}\n", note);
    check_groups(scene, mesh);
  });
  return broadcast(mesh);
}

}  // namespace chladni::cases
