#include "cases/mesh_scene.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "cases/ranks.hpp"
#include "common/petsc.hpp"
#include "mesh/generators.hpp"
#include "mesh/packed_mesh.hpp"
#include "report/progress.hpp"

namespace chladni::cases {

namespace {

/// The mesh of the first rank on all ranks.
mesh::Mesh broadcast(const mesh::Mesh& mesh)
{
  if (n_ranks() == 1) return mesh;
  std::vector<char> bytes;
  if (rank() == 0) {
    Packer packer;
    pack(packer, mesh);
    bytes = packer.bytes();
  }
  std::size_t size = bytes.size();
  MPI_Bcast(&size, sizeof(size), MPI_BYTE, 0, PETSC_COMM_WORLD);
  bytes.resize(size);
  constexpr std::size_t piece = std::size_t(1) << 30;  // an MPI count is an int
  for (std::size_t at = 0; at < size; at += piece) {
    const auto count = static_cast<int>(std::min(piece, size - at));
    MPI_Bcast(bytes.data() + at, count, MPI_BYTE, 0, PETSC_COMM_WORLD);
  }
  Unpacker unpacker(bytes);
  return mesh::unpack_mesh(unpacker);
}

}  // namespace

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

mesh::Mesh mesh_on_all_ranks(const scene::Scene& scene, const ChooseMesh& choose)
{
  mesh::Mesh mesh;
  on_first_rank([&] {
    mesh = mesh_scene(scene);
    for (const std::string& note : mesh.notes) report::tell_note(note);
    check_groups(scene, mesh);
    if (choose) mesh = choose(std::move(mesh));
  });
  return broadcast(mesh);
}

}  // namespace chladni::cases
