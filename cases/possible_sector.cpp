#include "cases/possible_sector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/harmonic_responses.hpp"
#include "cases/mesh_scene.hpp"
#include "cases/response_goal.hpp"
#include "cases/sector_checks.hpp"
#include "cases/size_of_mesh.hpp"
#include "common/error.hpp"
#include "mesh/repetition.hpp"
#include "mesh/sectors.hpp"
#include "plate/sections/profile.hpp"
#include "report/progress.hpp"

namespace chladni::cases {

namespace {

/// A coupling of the whole body has one reference node. That of a sector would be another one in
/// each, unless its group goes on from sector to sector about a reference node on the axis.
void refuse_groups_in_parts(const scene::Scene& scene, const mesh::Mesh& sector)
{
  const auto is_cut = [&](int node) {
    return std::ranges::any_of(sector.sectors.pairs,
                               [&](const auto& pair) { return pair[0] == node; });
  };
  for (const plate::Coupling& coupling : scene.couplings) {
    if (coupling.kind == plate::CouplingKind::link) continue;
    const std::vector<int>& group = mesh::find_group(sector, coupling.group).nodes;
    const bool is_on_axis =
        !coupling.at || mesh::is_on_axis(*coupling.at, mesh::outer_radius(sector));
    const bool is_rigid = coupling.kind == plate::CouplingKind::rigid;
    if (is_rigid && coupling.has_reference_node() && is_on_axis &&
        std::ranges::any_of(group, is_cut))
      continue;
    throw Error(
        fmt::format("sectors: the coupling \"{}\" joins nodes of several sectors that do not meet, "
                    "or their mean",
                    coupling.has_reference_node() ? coupling.name : coupling.group));
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

/// What the file of the whole body would tell and that of one sector not; empty where there is
/// nothing.
std::string lost_by(const scene::Scene& scene, const SectorModel& sector)
{
  if (!has_size(scene.mesh)) return "the node numbers of the mesh file";
  if (!scene.resultants.groups.empty()) return "the element numbers of section forces";
  if (!scene.stiffening.empty()) return "the geometric stiffness";
  const SectorSupport support = sector_support(scene, sector);
  if (support.names != scene.body.fixed) return "errors under the support of [body]";
  const bool certifies_responses = may_keep_responses(scene) && scene.ring_harmonics.empty();
  if (!certifies_responses ||
      harmonic_responses(scene, sector, described_whole(scene, sector), support))
    return "";
  return "the certificate of responses";
}

}  // namespace

SectorModel sector_of(const scene::Scene& scene, const mesh::Mesh& whole, int count)
{
  refuse_what_does_not_turn(scene, whole, count);
  mesh::Mesh first = mesh::one_sector(whole, count);
  refuse_groups_in_parts(scene, first);
  return sector_model(scene, std::move(first));
}

std::optional<SectorModel> possible_sector(const scene::Scene& scene, const mesh::Mesh& whole)
{
  using mesh::SectorSearch;
  const SectorSearch search = scene.mesh.sector_search;
  if (search == SectorSearch::none) return std::nullopt;
  try {
    const int count = mesh::n_repetitions(whole);
    if (count < least_sectors) throw Error("sectors: the mesh does not repeat about the z axis");
    SectorModel sector = sector_of(scene, whole, count);
    const bool is_asked = search == SectorSearch::asked;
    if (const std::string lost = is_asked ? "" : lost_by(scene, sector); !lost.empty()) {
      report::tell_note(fmt::format(
          "sectors: the body repeats {} times; from one sector, which sectors = \"auto\" in [mesh] "
          "would take, {} would be lost: the whole body is reduced",
          count, lost));
      return std::nullopt;
    }
    report::tell_note(
        fmt::format("sectors: the body repeats {} times and is reduced from one sector{}", count,
                    is_asked ? "" : "; sectors = 1 in [mesh] would take the whole body"));
    return sector;
  } catch (const Error& error) {
    if (search == SectorSearch::asked)
      report::tell_note(fmt::format("{}; the whole body is reduced", error.what()));
    return std::nullopt;
  }
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
