#include <algorithm>
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

enum class SectionKind { shell, beam };

/// A generated mesh has either surfaces or lines; a file shows when it is read.
void check_kind(const Table& section, SectionKind kind, const mesh::MeshOptions& mesh)
{
  if (mesh.beam && kind != SectionKind::beam) {
    section.refuse("type", "the generator \"beam\" makes lines; use \"beam\"");
  }
  if (!mesh.beam && !mesh.file && kind != SectionKind::shell) {
    section.refuse("type", "this generator makes surfaces; use \"shell\"");
  }
}

double read_shear_factor(const Table& section, std::string_view key, plate::BeamTheory theory)
{
  if (!section.has(key)) return 5.0 / 6.0;
  if (theory == plate::BeamTheory::bernoulli_euler) {
    section.refuse(key, "a beam of Bernoulli and Euler is rigid in shear; take this key out");
  }
  return section.number(key, {.above = 0.0, .at_most = 1.0});
}

std::optional<std::array<double, 3>> read_orientation(const Table& section)
{
  if (!section.has("orientation")) return std::nullopt;
  const std::array<double, 3> v = read_vector(section, "orientation", {});
  if (v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0) {
    section.refuse("orientation", "must not be zero; it points towards the z axis of the section");
  }
  return v;
}

plate::BeamSection read_beam_section(const Table& section, const std::string& group,
                                     const plate::Material& material)
{
  const Admissible second_moment{.above = 0.0, .unit = "m^4"};
  plate::BeamSection beam{.group = group,
                          .material = material,
                          .area = section.number("area", {.above = 0.0, .unit = "m^2"}),
                          .I_y = section.number("I_y", second_moment),
                          .I_z = section.number("I_z", second_moment),
                          .J = section.number("J", second_moment)};
  if (section.has("theory")) {
    beam.theory = section.choice<plate::BeamTheory>(
        "theory", {{"timoshenko", plate::BeamTheory::timoshenko},
                   {"bernoulli-euler", plate::BeamTheory::bernoulli_euler}});
  }
  beam.shear_factor_y = read_shear_factor(section, "shear_factor_y", beam.theory);
  beam.shear_factor_z = read_shear_factor(section, "shear_factor_z", beam.theory);
  if (section.has("rotary_inertia")) {
    beam.has_rotary_inertia =
        section.choice<bool>("rotary_inertia", {{"full", true}, {"none", false}});
  }
  beam.orientation = read_orientation(section);
  const bool alike = beam.I_y == beam.I_z && beam.shear_factor_y == beam.shear_factor_z;
  if (!beam.orientation && !alike) {
    section.refuse("I_y",
                   "differs from the z axis, so that the section needs `orientation`, a "
                   "vector [x, y, z] towards its z axis");
  }
  return beam;
}

void check_coupling_name(const Table& coupling, const std::set<std::string>& taken)
{
  const std::string name = coupling.text("name");
  if (taken.contains(name)) {
    coupling.refuse("name", "is the name of another coupling, ring or group");
  }
}

}  // namespace

std::vector<int> read_model_components(const Table& root)
{
  if (!root.has("model")) return {0, 1, 2, 3, 4, 5};
  std::vector<int> components = read_component_list(root.table("model"), "dofs");
  std::sort(components.begin(), components.end());
  return components;
}

Sections read_sections(const Table& root, const mesh::MeshOptions& mesh)
{
  const std::map<std::string, plate::Material> materials = read_materials(root);
  const std::vector<std::string> groups = surface_groups(mesh);
  std::set<std::string> taken;
  Sections sections;
  for (const Table& table : root.tables("section")) {
    const auto kind = table.choice<SectionKind>(
        "type", {{"shell", SectionKind::shell}, {"beam", SectionKind::beam}});
    const std::string group = read_group(table, groups);
    if (!taken.insert(group).second) table.refuse("group", "has another section already");
    check_kind(table, kind, mesh);
    const plate::Material& material = read_material_of(table, materials);
    if (kind == SectionKind::beam) {
      sections.beams.push_back(read_beam_section(table, group, material));
      continue;
    }
    sections.shells.push_back(
        {.group = group,
         .material = material,
         .thickness = table.number("thickness", {.above = 0.0, .unit = "m"})});
  }
  if (taken.empty()) root.refuse("section", "must hold at least one section");
  return sections;
}

std::vector<plate::RigidCoupling> read_couplings(const Table& root, const mesh::MeshOptions& mesh)
{
  const std::vector<std::string> groups = group_names(mesh);
  const std::vector<std::string> rings = ring_names(mesh);
  std::set<std::string> taken(groups.begin(), groups.end());
  taken.insert(rings.begin(), rings.end());
  std::vector<plate::RigidCoupling> couplings;
  if (!root.has("coupling")) return couplings;
  for (const Table& table : root.tables("coupling")) {
    if (table.text("type") == "averaging") {
      table.refuse("type", "averaging couplings are not available yet; use \"rigid\"");
    }
    table.choice<int>("type", {{"rigid", 0}});
    check_coupling_name(table, taken);
    couplings.push_back({.name = table.text("name"), .group = read_group(table, groups)});
    taken.insert(couplings.back().name);
  }
  return couplings;
}

}  // namespace chladni::cli
