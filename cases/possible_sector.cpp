#include "cases/possible_sector.hpp"

#include <fmt/format.h>

#include "cases/harmonic_options.hpp"
#include "cases/ranks.hpp"
#include "cases/sector_model.hpp"
#include "common/error.hpp"
#include "mesh/repetition.hpp"

namespace chladni::cases {

std::optional<mesh::Mesh> possible_sector(const scene::Scene& scene, const mesh::Mesh& whole)
{
  constexpr int least = 3;
  if (!scene.mesh.finds_sectors) return std::nullopt;
  std::optional<mesh::Mesh> sector;
  std::string found;
  try {
    const int count = mesh::n_repetitions(whole);
    if (count < least) throw Error("sectors: the mesh does not repeat about the z axis");
    check_method(scene.reduce.method);
    sector = mesh::one_sector(whole, count);
    sector_model(scene, *sector);  // tells what harmonics cannot do
    found = fmt::format("sectors: the body repeats {} times and is reduced from one sector", count);
  } catch (const Error& error) {
    sector.reset();
    found = fmt::format("{}; the whole body is reduced", error.what());
  }
  if (rank() == 0) fmt::print(stderr, "note: {}\n", found);
  return sector;
}

}  // namespace chladni::cases
