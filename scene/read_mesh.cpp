#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "scene/read_mesh_parts.hpp"

namespace chladni::scene {
namespace {

mesh::RingOptions read_ring(const Table& ring, const Admissible& radii)
{
  mesh::RingOptions options{.name = ring.text("name"),
                            .radius = ring.number("radius", radii),
                            .nodes = ring.integer("nodes")};
  if (ring.has("z")) options.z = ring.number("z");
  return options;
}

std::string read_file_name(const Table& mesh, const std::string& scene_path)
{
  const std::filesystem::path file = mesh.text("file");
  if (!mesh::mesh_source(file.string())) {
    mesh.refuse("file", "must be a mesh file: " + mesh::extensions_of() +
                            " (a deck of Nastran or, the last one, of Abaqus)");
  }
  return (std::filesystem::path(scene_path).parent_path() / file).lexically_normal().string();
}

/// What 1 in a file is, m.
double read_length_unit(const Table& mesh)
{
  return mesh.choice<double>("length_unit",
                             {{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"inch", 0.0254}});
}

/// The names go into a script of Gmsh.
void check_is_identifier(const Table& table, const std::string& name)
{
  const auto is_letter = [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
  };
  const auto is_part = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); };
  if (is_letter(name.front()) && std::ranges::all_of(name, is_part)) return;
  table.refuse(name, "names a parameter of Gmsh: letters, digits and _ only");
}

std::vector<std::pair<std::string, double>> read_parameters(const Table& mesh)
{
  std::vector<std::pair<std::string, double>> parameters;
  const Table table = mesh.table("parameters");
  for (const std::string& name : table.names()) {
    check_is_identifier(table, name);
    parameters.emplace_back(name, table.number(name, {}));
  }
  return parameters;
}

std::vector<mesh::EntityGroup> read_entity_groups(const Table& mesh)
{
  std::vector<mesh::EntityGroup> groups;
  const Table table = mesh.table("groups");
  for (const std::string& name : table.names()) {
    groups.push_back({.name = name, .entities = table.texts(name)});
    if (groups.back().entities.empty())
      table.refuse(name, "must name entities, such as \"surface_1\"");
  }
  return groups;
}

mesh::Coincident read_coincident_nodes(const Table& mesh)
{
  return mesh.choice<mesh::Coincident>("coincident_nodes", {{"refuse", mesh::Coincident::refuse},
                                                            {"merge", mesh::Coincident::merge},
                                                            {"keep", mesh::Coincident::keep}});
}

mesh::Doubled read_doubled_elements(const Table& mesh)
{
  return mesh.choice<mesh::Doubled>("doubled_elements", {{"refuse", mesh::Doubled::refuse},
                                                         {"merge", mesh::Doubled::merge},
                                                         {"keep", mesh::Doubled::keep}});
}

/// Refuses a key that makes no sense with this kind of file.
void check_only_for(const Table& mesh, const char* key, bool makes_sense, const char* why)
{
  if (mesh.has(key) && !makes_sense) mesh.refuse(key, why);
}

/// m; nothing where it is chosen later
std::optional<double> read_size_of_step(const Table& mesh, Size size)
{
  if (size == Size::given) return mesh.number("element_size");
  if (mesh.has("element_size"))
    mesh.refuse("element_size", "`accuracy` chooses it; take this key out");
  return std::nullopt;
}

mesh::MeshOptions read_file(const Table& mesh, Size size, const std::string& scene_path)
{
  mesh::MeshOptions options{.file = read_file_name(mesh, scene_path)};
  const mesh::MeshSource source = *mesh::mesh_source(*options.file);
  const bool is_msh = source == mesh::MeshSource::msh;
  const bool is_geo = source == mesh::MeshSource::geo;
  const bool is_step = source == mesh::MeshSource::step;
  const bool is_finished = !is_msh && !is_geo && !is_step;
  check_only_for(mesh, "element_order", is_geo || is_step,
                 is_msh ? "a .msh file has its own order; take this key out"
                        : "such a file has its own order; take this key out");
  check_only_for(mesh, "groups", !is_finished,
                 "such a file has no surfaces or curves, only its own groups");
  check_only_for(mesh, "element_size", is_step, "is for .step files; a .geo has its own sizes");
  check_only_for(mesh, "parameters", is_geo, "only a .geo file has parameters");
  check_only_for(mesh, "doubled_elements", mesh::is_deck(source),
                 "is for decks; elsewhere they are one element in several groups");
  check_only_for(mesh, "length_unit", !is_step, "a .step file tells its own unit");
  if (mesh.has("element_order")) options.element_order = read_element_order(mesh);
  if (is_step) options.element_size = read_size_of_step(mesh, size);
  if (mesh.has("parameters")) options.parameters = read_parameters(mesh);
  if (mesh.has("length_unit") || is_finished) options.length_unit = read_length_unit(mesh);
  if (mesh.has("groups")) options.groups = read_entity_groups(mesh);
  options.sectors = read_sectors(mesh);
  if (mesh.has("coincident_nodes")) options.coincident_nodes = read_coincident_nodes(mesh);
  if (mesh.has("doubled_elements")) options.doubled_elements = read_doubled_elements(mesh);
  if (mesh.has("merge_tolerance")) options.merge_tolerance = mesh.number("merge_tolerance");
  std::vector<std::string> taken;
  for (const mesh::EntityGroup& group : options.groups) taken.push_back(group.name);
  options.rings = read_rings(mesh, taken, {.above = 0.0, .unit = "m"});
  return options;
}

mesh::SectorSearch read_sector_search(const Table& root, const Table& mesh)
{
  if (mesh.has("sectors"))
    return finds_sectors(mesh) ? mesh::SectorSearch::asked : mesh::SectorSearch::none;
  return root.has("accuracy") ? mesh::SectorSearch::where_nothing_is_lost
                              : mesh::SectorSearch::none;
}

}  // namespace

int read_sectors(const Table& mesh)
{
  if (!mesh.has("sectors") || finds_sectors(mesh)) return 1;
  const int sectors = mesh.integer("sectors");
  if (sectors == 2) mesh.refuse("sectors", "must be 1, for the whole body, or 3 and more");
  return sectors;
}

bool finds_sectors(const Table& mesh)
{
  if (!mesh.has("sectors") || !mesh.is_text("sectors")) return false;
  if (mesh.text("sectors") == "auto") return true;
  mesh.refuse("sectors", "must be an integer or \"auto\"");
}

int read_element_order(const Table& mesh)
{
  return mesh.integer("element_order");
}

std::vector<mesh::RingOptions> read_rings(const Table& mesh, const std::vector<std::string>& taken,
                                          const Admissible& radii)
{
  std::set<std::string> names(taken.begin(), taken.end());
  std::set<std::pair<double, std::optional<double>>> circles;
  std::vector<mesh::RingOptions> rings;
  if (!mesh.has("rings")) return rings;
  for (const Table& table : mesh.tables("rings")) {
    const mesh::RingOptions ring = read_ring(table, radii);
    if (!names.insert(ring.name).second)
      table.refuse("name", "is the name of another ring or group of the mesh");
    if (!circles.insert({ring.radius, ring.z}).second)
      table.refuse("radius", "is the radius of another ring");
    rings.push_back(ring);
  }
  return rings;
}

mesh::MeshOptions read_mesh(const Table& root, const std::string& scene_path)
{
  const Table mesh = root.table("mesh");
  const Size size = root.has("accuracy") ? Size::chosen : Size::given;
  const bool is_file = mesh.only_one_of({"generator", "file"}) == "file";
  mesh::MeshOptions options =
      is_file ? read_file(mesh, size, scene_path) : read_generator(mesh, size);
  if (options.file || options.annulus || options.hat_disc)
    options.sector_search = read_sector_search(root, mesh);
  return options;
}

const std::vector<mesh::RingOptions>& rings_of(const mesh::MeshOptions& mesh)
{
  if (mesh.annulus) return mesh.annulus->rings;
  return mesh.hat_disc ? mesh.hat_disc->rings : mesh.rings;
}

std::vector<std::string> ring_names(const mesh::MeshOptions& mesh)
{
  std::vector<std::string> names;
  for (const mesh::RingOptions& ring : rings_of(mesh)) names.push_back(ring.name);
  return names;
}

std::vector<std::string> group_names(const Scene& scene)
{
  if (scene.mesh.file) return scene.file_groups;
  std::vector<std::string> names = generated_groups(scene.mesh);
  if (names.empty()) return {};
  const std::vector<std::string> rings = ring_names(scene.mesh);
  names.insert(names.end(), rings.begin(), rings.end());
  return names;
}

}  // namespace chladni::scene
