#include "mesh/own_readers.hpp"

#include "mesh/decks/read_deck.hpp"
#include "mesh/exchange/exchange_mesh.hpp"

namespace chladni::mesh {

bool has_own_reader(const std::string& file)
{
  return is_deck(file) || is_exchange(file);
}

Mesh read_here(const MeshOptions& options)
{
  Mesh mesh = is_deck(options.file.value()) ? deck_mesh(options) : exchange_mesh(options);
  scale(mesh, options.length_unit);
  return mesh;
}

void scale(Mesh& mesh, double metres)
{
  for (auto& x : mesh.positions)
    for (double& coordinate : x) coordinate *= metres;
}

}  // namespace chladni::mesh
