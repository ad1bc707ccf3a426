#include <map>
#include <set>

#include "cli/scene/read_tables.hpp"

namespace chladni::cli {
namespace {

plate::Material read_material(const Table& material)
{
  return {.young = material.number("young", {.above = 0.0, .unit = "Pa"}),
          .poisson = material.number("poisson", {.above = -1.0, .below = 0.5}),
          .density = material.number("density", {.above = 0.0, .unit = "kg/m^3"})};
}

std::map<std::string, plate::Material> read_materials(const Table& root)
{
  const Table table = root.table("material");
  std::map<std::string, plate::Material> materials;
  for (const std::string& name : table.names()) {
    materials[name] = read_material(table.table(name));
  }
  return materials;
}

/// The group of a section or a coupling, checked where the scene alone knows the groups.
std::string read_group(const Table& table, const std::vector<std::string>& groups)
{
  const std::string group = table.text("group");
  if (!groups.empty() && !contains(groups, group)) {
    table.refuse("group", no_such_name("group", group, groups));
  }
  return group;
}

const plate::Material& read_material_of(const Table& section,
                                        const std::map<std::string, plate::Material>& materials)
{
  const auto found = materials.find(section.text("material"));
  if (found != materials.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, material] : materials) names.push_back(name);
  section.refuse("material", no_such_name("material", section.text("material"), names));
}

/// A constant, or a table over a coordinate or the radius.
plate::Profile read_profile(const Table& section, std::string_view key, const Admissible& lengths)
{
  if (!section.has(key) || !section.is_table(key)) return section.number(key, lengths);
  using plate::Coordinate;
  const Table table = section.table(key);
  const auto over = table.choice<Coordinate>("over", {{"x", Coordinate::x},
                                                      {"y", Coordinate::y},
                                                      {"z", Coordinate::z},
                                                      {"radius", Coordinate::radius}});
  const std::vector<double> at = table.numbers("at", {.unit = "m"});
  if (at.size() < 2) table.refuse("at", "must hold at least two places");
  for (std::size_t i = 1; i < at.size(); ++i) {
    if (at[i] <= at[i - 1]) table.refuse_element("at", i, "must be larger than the one before");
  }
  const std::vector<double> values = table.numbers("values", lengths);
  if (values.size() != at.size()) table.refuse("values", "must be as many as the numbers of at");
  return {over, at, values};
}

plate::Coupling read_coupling(const Table& table, const std::vector<std::string>& groups)
{
  using plate::CouplingKind;
  const auto kind = table.choice<CouplingKind>("type", {{"rigid", CouplingKind::rigid},
                                                        {"averaging", CouplingKind::averaging},
                                                        {"link", CouplingKind::link}});
  plate::Coupling coupling{.name = {}, .group = read_group(table, groups), .kind = kind};
  if (kind != CouplingKind::link) {
    coupling.name = table.text("name");
    return coupling;
  }
  coupling.to = table.text("to");
  if (!groups.empty() && !contains(groups, coupling.to)) {
    table.refuse("to", no_such_name("group", coupling.to, groups));
  }
  if (coupling.to == coupling.group) table.refuse("to", "must be another group");
  return coupling;
}

void check_coupling_name(const Table& coupling, const std::set<std::string>& taken)
{
  const std::string name = coupling.text("name");
  if (taken.contains(name)) {
    coupling.refuse("name", "is the name of another coupling, ring or group");
  }
}

}  // namespace

std::vector<plate::ShellSection> read_sections(const Table& root, const mesh::MeshOptions& mesh)
{
  const std::map<std::string, plate::Material> materials = read_materials(root);
  const std::vector<std::string> groups = surface_groups(mesh);
  std::set<std::string> taken;
  std::vector<plate::ShellSection> sections;
  for (const Table& table : root.tables("section")) {
    table.choice<int>("type", {{"shell", 0}});
    const std::string group = read_group(table, groups);
    if (!taken.insert(group).second) table.refuse("group", "has another section already");
    sections.push_back(
        {.group = group,
         .material = read_material_of(table, materials),
         .thickness = read_profile(table, "thickness", {.above = 0.0, .unit = "m"}),
         .offset = table.has("offset") ? read_profile(table, "offset", {.unit = "m"}) : 0.0});
  }
  if (sections.empty()) root.refuse("section", "must hold at least one section");
  return sections;
}

std::vector<plate::Coupling> read_couplings(const Table& root, const mesh::MeshOptions& mesh)
{
  const std::vector<std::string> groups = group_names(mesh);
  const std::vector<std::string> rings = ring_names(mesh);
  std::set<std::string> taken(groups.begin(), groups.end());
  taken.insert(rings.begin(), rings.end());
  std::vector<plate::Coupling> couplings;
  if (!root.has("coupling")) return couplings;
  for (const Table& table : root.tables("coupling")) {
    couplings.push_back(read_coupling(table, groups));
    if (couplings.back().kind == plate::CouplingKind::link) continue;
    check_coupling_name(table, taken);
    taken.insert(couplings.back().name);
  }
  return couplings;
}

}  // namespace chladni::cli
