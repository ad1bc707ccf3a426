#include "cases/possible_sector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/mesh_scene.hpp"
#include "cases/sector_checks.hpp"
#include "common/error.hpp"
#include "mesh/repetition.hpp"
#include "mesh/sectors.hpp"
#include "plate/sections/profile.hpp"
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

/// A thickness or an offset that a turn by one sector changes.
void refuse_uneven(const plate::Profile& profile, const std::string& group, const mesh::Mesh& whole,
                   int count)
{
  constexpr double digits = 1e-9;
  const mesh::Sectors sectors{.count = count, .pairs = {}};
  for (const int node : mesh::find_group(whole, group).nodes) {
    const std::array<double, 3> x = whole.positions[std::size_t(node)];
    const double here = plate::value_at(profile, x);
    const double there = plate::value_at(profile, mesh::turned(sectors, x));
    if (std::abs(here - there) <= digits * std::max(std::abs(here), std::abs(there))) continue;
    throw Error(fmt::format(
        "sectors: the section of \"{}\" is not the same in all of the {} repetitions of the mesh",
        group, count));
  }
}

/// What has a direction of its own: the sectors of a whole body do not turn it.
void require_turning(const std::string& place, const char* what, bool turns)
{
  if (turns) return;
  throw Error(fmt::format(
      "sectors: the {} \"{}\" has directions of its own, which do not turn with the sectors", what,
      place));
}

void refuse_what_does_not_turn(const scene::Scene& scene, const mesh::Mesh& whole, int count)
{
  for (const plate::ShellSection& section : scene.sections) {
    refuse_uneven(section.thickness, section.group, whole, count);
    refuse_uneven(section.offset, section.group, whole, count);
  }
  for (const plate::BeamSection& beam : scene.beams) {
    const bool turns =
        !beam.orientation || ((*beam.orientation)[0] == 0.0 && (*beam.orientation)[1] == 0.0);
    require_turning(beam.group, "section of beams", turns);
  }
  for (const plate::PointMass& mass : scene.masses)
    require_turning(mass.at, "mass at", turns_with_sectors(mass));
  for (const plate::Spring& spring : scene.springs)
    require_turning(spring.at, "spring at", turns_with_sectors(spring));
}

/// A scene with `accuracy` chooses all that it does not say, but not what its masters are: those of
/// a sector are harmonics, which not every format can hold.
void tell_of_sectors(const scene::Scene& scene, const mesh::Mesh& whole, int least)
{
  if (!scene.accuracy || whole.sectors.count > 1) return;
  if (const int count = mesh::n_repetitions(whole); count >= least) {
    report::tell_note(fmt::format(
        "the body repeats {} times about the z axis: sectors = \"auto\" in [mesh] would reduce it "
        "from one sector, at a part of the cost",
        count));
  }
}

}  // namespace

std::optional<SectorModel> possible_sector(const scene::Scene& scene, const mesh::Mesh& whole)
{
  constexpr int least = 3;
  if (!scene.mesh.finds_sectors) {
    tell_of_sectors(scene, whole, least);
    return std::nullopt;
  }
  std::optional<SectorModel> sector;
  std::string found;
  try {
    const int count = mesh::n_repetitions(whole);
    if (count < least) throw Error("sectors: the mesh does not repeat about the z axis");
    refuse_what_does_not_turn(scene, whole, count);
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
