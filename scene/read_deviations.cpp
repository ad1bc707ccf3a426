#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "scene/read_mesh_parts.hpp"
#include "scene/read_tables.hpp"

namespace chladni::scene {

namespace {

enum class What { section, mass, spring };

/// @param count  of the body, of which one is meshed
std::vector<int> read_sector_list(const Table& deviation, int count)
{
  const std::vector<int> sectors = deviation.integers("sectors");
  if (sectors.empty()) deviation.refuse("sectors", "must name at least one sector");
  std::set<int> taken;
  for (std::size_t i = 0; i < sectors.size(); ++i) {
    if (sectors[i] >= count) {
      deviation.refuse_element(
          "sectors", i, fmt::format("the {} sectors of the body are 0 to {}", count, count - 1));
    }
    if (!taken.insert(sectors[i]).second) deviation.refuse_element("sectors", i, "is there twice");
  }
  return {taken.begin(), taken.end()};
}

plate::ShellSection read_deviating_section(const Table& table, const Table& root,
                                           const Scene& scene)
{
  const std::string group = table.text("group");
  const auto own = std::ranges::find(scene.sections, group, &plate::ShellSection::group);
  if (own == scene.sections.end()) {
    std::vector<std::string> groups;
    for (const plate::ShellSection& section : scene.sections) groups.push_back(section.group);
    table.refuse("group", no_such_name("group with a shell section", group, groups));
  }
  plate::ShellSection section = *own;
  if (!table.has("material") && !table.has("thickness"))
    table.refuse("group", "the deviation needs `thickness` or `material`");
  if (table.has("material")) section.material = read_material_of(table, root);
  if (table.has("thickness")) {
    section.thickness = read_profile(table, "thickness");
    if (section.thickness == own->thickness)
      table.refuse("thickness", "equals that of the group's section, so nothing deviates");
  }
  return section;
}

Deviation read_deviation(const Table& table, const Table& root, const Scene& scene)
{
  const auto what = table.choice<What>(
      "type", {{"section", What::section}, {"mass", What::mass}, {"spring", What::spring}});
  const Table mesh = root.table("mesh");
  const int count = read_sectors(mesh);
  Deviation deviation{};
  if (what == What::section) deviation.section = read_deviating_section(table, root, scene);
  if (count == 1 && (what != What::section || table.has("sectors"))) {
    table.refuse(
        table.has("sectors") ? "sectors" : "type",
        "needs a number of `sectors` in [mesh]; in the mesh of a whole body give the place "
        "a group of its own, with a [[section]], [[mass]] or [[spring]]");
  }
  if (what != What::section || table.has("sectors"))
    deviation.sectors = read_sector_list(table, count);
  if (what == What::mass) {
    deviation.mass = read_mass(table, scene);
    if (deviation.mass->mass == 0.0) table.refuse("mass", "must not be zero");
  }
  if (what == What::spring) deviation.spring = read_spring(table, scene);
  return deviation;
}

/// Two sections of one group in one sector.
void refuse_second_section(const Table& table, const Deviation& deviation,
                           const std::vector<Deviation>& others)
{
  if (!deviation.section) return;
  for (const Deviation& other : others) {
    if (!other.section || other.section->group != deviation.section->group) continue;
    const auto is_shared = [&](int sector) {
      return std::ranges::count(other.sectors, sector) > 0;
    };
    if (deviation.sectors.empty() || other.sectors.empty() ||
        std::ranges::any_of(deviation.sectors, is_shared))
      table.refuse("group", "has another deviation in one of these sectors already");
  }
}

}  // namespace

void read_deviations(const Table& root, Scene& scene)
{
  if (!root.has("deviation")) return;
  const bool is_sector = read_sectors(root.table("mesh")) > 1;
  std::vector<Deviation> known;
  for (const Table& table : root.tables("deviation")) {
    const Deviation deviation = read_deviation(table, root, scene);
    refuse_second_section(table, deviation, known);
    known.push_back(deviation);
    if (is_sector) continue;
    *std::ranges::find(scene.sections, deviation.section->group, &plate::ShellSection::group) =
        *deviation.section;
  }
  if (is_sector) scene.deviations = std::move(known);
}

}  // namespace chladni::scene
