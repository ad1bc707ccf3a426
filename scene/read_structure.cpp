#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "common/decimal_comma.hpp"
#include "scene/read_mesh.hpp"
#include "scene/readers.hpp"

namespace chladni::scene {

namespace {

plate::Material read_material(const Table& material)
{
  return {.young = material.number("young"),
          .poisson = material.number("poisson"),
          .density = material.number("density"),
          .loss_factor = material.has("loss_factor") ? material.number("loss_factor") : 0.0};
}

std::map<std::string, plate::Material> read_materials(const Table& root)
{
  const Table table = root.table("material");
  std::map<std::string, plate::Material> materials;
  for (const std::string& name : table.names()) materials[name] = read_material(table.table(name));
  return materials;
}

/// The group of a section or a coupling, checked where the groups are known.
std::string read_group(const Table& table, const std::vector<std::string>& groups)
{
  const std::string group = table.text("group");
  if (!groups.empty() && !contains(groups, group))
    table.refuse("group", no_such_name("group", group, groups));
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

std::optional<double> read_loss_factor(const Table& section)
{
  if (!section.has("loss_factor")) return std::nullopt;
  return section.number("loss_factor");
}

/// @param couplings  names of all couplings
plate::Coupling read_coupling(const Table& table, const std::vector<std::string>& groups,
                              const std::vector<std::string>& couplings)
{
  using plate::CouplingKind;
  const auto kind = table.choice<CouplingKind>("type", {{"rigid", CouplingKind::rigid},
                                                        {"averaging", CouplingKind::averaging},
                                                        {"link", CouplingKind::link}});
  plate::Coupling coupling{.name = {}, .group = read_group(table, groups), .kind = kind};
  const bool is_rigid = kind == CouplingKind::rigid;
  if (kind == CouplingKind::averaging || (is_rigid && !table.has("to"))) {
    coupling.name = table.text("name");
    if (table.has("at")) coupling.at = read_vector(table, "at");
    return coupling;
  }
  for (const char* key : {"name", "at"})
    if (table.has(key)) table.refuse(key, "is of a reference node; with `to` there is none");
  coupling.to = table.text("to");
  const bool is_there =
      contains(groups, coupling.to) || (is_rigid && contains(couplings, coupling.to));
  if (!groups.empty() && !is_there)
    table.refuse("to", no_such_name(is_rigid ? "group or coupling" : "group", coupling.to, groups));
  if (coupling.to == coupling.group) table.refuse("to", "must be another group");
  return coupling;
}

enum class SectionKind { shell, beam, solid };

/// A generated mesh has either surfaces or lines; a file shows when it is read.
void check_kind(const Table& section, SectionKind kind, const mesh::MeshOptions& mesh)
{
  if (mesh.beam && kind != SectionKind::beam)
    section.refuse("type", "the generator \"beam\" makes lines; use \"beam\"");
  if (mesh.extrude && kind != SectionKind::solid)
    section.refuse("type", "`extrude` makes solids; use \"solid\"");
  if (!mesh.beam && !mesh.extrude && !mesh.file && kind != SectionKind::shell)
    section.refuse("type", "this generator makes surfaces; use \"shell\", or `extrude` in [mesh]");
}

double read_shear_factor(const Table& section, std::string_view key, plate::BeamTheory theory)
{
  if (!section.has(key)) return 5.0 / 6.0;
  if (theory == plate::BeamTheory::bernoulli_euler)
    section.refuse(key, "a beam of Bernoulli and Euler is rigid in shear; take this key out");
  return section.number(key);
}

std::optional<std::array<double, 3>> read_orientation(const Table& section)
{
  if (!section.has("orientation")) return std::nullopt;
  const std::array<double, 3> v = read_vector(section, "orientation");
  if (v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0)
    section.refuse("orientation", "must not be zero; it points towards the z axis of the section");
  return v;
}

plate::BeamSection read_beam_section(const Table& section, const std::string& group,
                                     const plate::Material& material)
{
  plate::BeamSection beam{.group = group,
                          .material = material,
                          .area = section.number("area"),
                          .I_y = section.number("I_y"),
                          .I_z = section.number("I_z"),
                          .J = section.number("J")};
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
  beam.loss_factor = read_loss_factor(section);
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
  if (taken.contains(name))
    coupling.refuse("name", "is the name of another coupling, ring or group");
}

}  // namespace

plate::Profile read_profile(const Table& section, std::string_view key)
{
  if (section.has(key) && section.is_text(key)) {
    const std::string formula = section.text(key);
    if (const std::string wrong = decimal_comma_in(formula); !wrong.empty())
      section.refuse(key, wrong);
    return plate::Profile::by_formula(formula);
  }
  if (!section.has(key) || !section.is_table(key)) return section.number(key);
  using plate::Coordinate;
  const Table table = section.table(key);
  const auto over = table.choice<Coordinate>("over", {{"x", Coordinate::x},
                                                      {"y", Coordinate::y},
                                                      {"z", Coordinate::z},
                                                      {"radius", Coordinate::radius}});
  const std::vector<double> at = table.numbers("at");
  if (at.size() < 2) table.refuse("at", "must hold at least two places");
  for (std::size_t i = 1; i < at.size(); ++i)
    if (at[i] <= at[i - 1]) table.refuse_element("at", i, "must be larger than the one before");
  const std::vector<double> values = table.numbers("values");
  if (values.size() != at.size()) table.refuse("values", "must be as many as the numbers of at");
  return {over, at, values};
}

plate::Material read_material_of(const Table& table, const Table& root)
{
  return read_material_of(table, read_materials(root));
}

std::vector<int> read_model_components(const Table& root, const Sections& sections)
{
  if (!sections.solids.empty() && root.has("model"))
    root.refuse("model", "solids have the displacements x, y, z at each node and no other DOF");
  if (root.has("model") && root.table("mesh").has("matrices"))
    root.refuse("model", "the matrices tell the DOFs of each node");
  if (!root.has("model")) return {0, 1, 2, 3, 4, 5};
  std::vector<int> components = read_component_list(root.table("model"), "dofs");
  std::ranges::sort(components);
  return components;
}

Sections read_sections(const Table& root, const Scene& scene)
{
  if (scene.mesh.matrices) {
    for (const char* key : {"section", "material"})
      if (root.has(key)) root.refuse(key, "mesh.matrices stands in place of sections");
    return {};
  }
  const std::map<std::string, plate::Material> materials = read_materials(root);
  const std::vector<std::string> groups =
      scene.mesh.file ? group_names(scene) : surface_groups(scene.mesh);
  std::set<std::string> taken;
  Sections sections;
  for (const Table& table : root.tables("section")) {
    const auto kind = table.choice<SectionKind>("type", {{"shell", SectionKind::shell},
                                                         {"beam", SectionKind::beam},
                                                         {"solid", SectionKind::solid}});
    const std::string group = read_group(table, groups);
    if (!taken.insert(group).second) table.refuse("group", "has another section already");
    check_kind(table, kind, scene.mesh);
    const plate::Material& material = read_material_of(table, materials);
    if (kind == SectionKind::beam) {
      sections.beams.push_back(read_beam_section(table, group, material));
      continue;
    }
    if (kind == SectionKind::solid) {
      sections.solids.push_back(
          {.group = group, .material = material, .loss_factor = read_loss_factor(table)});
      continue;
    }
    sections.shells.push_back({.group = group,
                               .material = material,
                               .thickness = read_profile(table, "thickness"),
                               .offset = table.has("offset") ? read_profile(table, "offset") : 0.0,
                               .loss_factor = read_loss_factor(table)});
  }
  if (taken.empty()) root.refuse("section", "must hold at least one section");
  return sections;
}

std::vector<plate::Coupling> read_couplings(const Table& root, const Scene& scene)
{
  const std::vector<std::string> groups = group_names(scene);
  const std::vector<std::string> rings = ring_names(scene.mesh);
  std::set<std::string> taken(groups.begin(), groups.end());
  taken.insert(rings.begin(), rings.end());
  std::vector<plate::Coupling> couplings;
  if (!root.has("coupling")) return couplings;
  std::vector<std::string> names;
  for (const Table& table : root.tables("coupling"))
    if (table.has("name")) names.push_back(table.text("name"));
  for (const Table& table : root.tables("coupling")) {
    couplings.push_back(read_coupling(table, groups, names));
    if (couplings.back().kind == plate::CouplingKind::averaging && scene.components.size() != 6) {
      table.refuse("type",
                   "an average needs all six DOFs of each node; use \"rigid\", or take "
                   "[model] out");
    }
    if (!couplings.back().has_reference_node()) continue;
    check_coupling_name(table, taken);
    taken.insert(couplings.back().name);
  }
  return couplings;
}

namespace {

/// Groups, rings and couplings; groups of a mesh file are known once it is read.
std::string read_place(const Table& table, std::string_view key, const Scene& scene)
{
  const std::string name = table.text(key);
  std::vector<std::string> names = group_names(scene);
  if (names.empty()) return name;
  for (const plate::Coupling& coupling : scene.couplings)
    if (!coupling.name.empty()) names.push_back(coupling.name);
  if (!contains(names, name)) table.refuse(key, no_such_name("group or coupling", name, names));
  return name;
}

/// The symmetric tensor about the centre of mass, or three moments.
std::array<double, 6> read_inertia(const Table& mass)
{
  const std::vector<double> values = mass.numbers("inertia");
  if (values.size() != 3 && values.size() != 6)
    mass.refuse("inertia", "must be three moments [xx, yy, zz] or six [xx, yy, zz, xy, xz, yz]");
  std::array<double, 6> inertia{};
  std::ranges::copy(values, inertia.begin());
  const auto [xx, yy, zz, xy, xz, yz] = inertia;
  const double minor = xx * yy - xy * xy;
  const double det = zz * minor - xx * yz * yz - yy * xz * xz + 2.0 * xy * xz * yz;
  const double round_off = 1e-12 * (xx + yy + zz);
  const bool semidefinite =
      xx >= 0.0 && yy >= 0.0 && zz >= 0.0 && minor >= -round_off * (xx + yy) &&
      xx * zz - xz * xz >= -round_off * (xx + zz) && yy * zz - yz * yz >= -round_off * (yy + zz) &&
      det >= -round_off * (xx + yy + zz) * (xx + yy + zz);
  if (!semidefinite || xx + yy < zz - round_off || yy + zz < xx - round_off ||
      zz + xx < yy - round_off) {
    mass.refuse("inertia",
                "no rigid body has these moments: none is negative or exceeds the sum of the "
                "other two, and xy = -int x y dm are not too large");
  }
  return inertia;
}

}  // namespace

plate::PointMass read_mass(const Table& table, const Scene& scene)
{
  plate::PointMass mass{.at = read_place(table, "at", scene), .mass = table.number("mass")};
  if (table.has("inertia")) mass.inertia = read_inertia(table);
  if (table.has("offset")) mass.offset = read_vector(table, "offset");
  return mass;
}

plate::Spring read_spring(const Table& table, const Scene& scene)
{
  plate::Spring spring{.at = read_place(table, "at", scene)};
  if (table.has("to")) {
    spring.to = read_place(table, "to", scene);
    if (*spring.to == spring.at) table.refuse("to", "is the place where the spring begins");
  }
  if (!table.has("stiffness") && !table.has("damping"))
    table.refuse("at", "the spring needs `stiffness` or `damping`, like { z = 1e6 }");
  if (table.has("stiffness")) spring.stiffness = read_by_component(table, "stiffness");
  if (table.has("damping")) spring.damping = read_by_component(table, "damping");
  if (table.has("loss_factor")) {
    if (!table.has("stiffness"))
      table.refuse("loss_factor", "is that of the stiffness; give `stiffness`, or `damping` alone");
    spring.loss_factor = table.number("loss_factor");
  }
  return spring;
}

std::vector<plate::PointMass> read_masses(const Table& root, const Scene& scene)
{
  std::vector<plate::PointMass> masses;
  if (!root.has("mass")) return masses;
  for (const Table& table : root.tables("mass")) masses.push_back(read_mass(table, scene));
  return masses;
}

std::vector<plate::Spring> read_springs(const Table& root, const Scene& scene)
{
  std::vector<plate::Spring> springs;
  if (!root.has("spring")) return springs;
  for (const Table& table : root.tables("spring")) springs.push_back(read_spring(table, scene));
  return springs;
}

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
