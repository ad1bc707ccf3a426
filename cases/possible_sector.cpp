#include "cases/possible_sector.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cases/mesh_scene.hpp"
#include "common/error.hpp"
#include "mesh/repetition.hpp"
#include "report/progress.hpp"

namespace chladni::cases {

namespace {

/// A coupling of the whole body has one reference node. That of a sector would be another one in
/// each, unless its group goes on from sector to sector.
void refuse_groups_in_parts(const scene::Scene& scene, const mesh::Mesh& sector)
{
  const auto is_cut = [&](int node) {
    return std::ranges::any_of(sector.sectors.pairs,
                               [&](const auto& pair) { return pair[0] == node; });
  };
  for (const plate::Coupling& coupling : scene.couplings) {
    if (coupling.kind == plate::CouplingKind::link) continue;
    const std::vector<int>& group = mesh::find_group(sector, coupling.group).nodes;
    if (coupling.kind == plate::CouplingKind::rigid && std::ranges::any_of(group, is_cut)) continue;
    throw Error(
        fmt::format("sectors: the coupling \"{}\" joins nodes of several sectors that do not meet, "
                    "or their mean",
                    coupling.name));
  }
}

}  // namespace

std::optional<SectorModel> possible_sector(const scene::Scene& scene, const mesh::Mesh& whole)
{
  constexpr int least = 3;
  if (!scene.mesh.finds_sectors) return std::nullopt;
  std::optional<SectorModel> sector;
  std::string found;
  try {
    const int count = mesh::n_repetitions(whole);
    if (count < least) throw Error("sectors: the mesh does not repeat about the z axis");
    mesh::Mesh first = mesh::one_sector(whole, count);
    refuse_groups_in_parts(scene, first);
    sector = sector_model(scene, std::move(first));
    found = fmt::format("sectors: the body repeats {} times and is reduced from one sector", count);
  } catch (const Error& error) {
    sector.reset();
    found = fmt::format("{}; the whole body is reduced", error.what());
  }
  report::tell_note(found);
  return sector;
}

MeshedScene meshed_scene(const scene::Scene& scene)
{
  MeshedScene meshed;
  meshed.mesh = mesh_on_all_ranks(scene, [&](mesh::Mesh whole) {
    meshed.sector = possible_sector(scene, whole);
    return meshed.sector ? meshed.sector->mesh : std::move(whole);
  });
  return meshed;
}

}  // namespace chladni::cases
