#include "mesh/gmsh/gmsh.hpp"

#include <fmt/format.h>
#include <gmsh.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <numbers>
#include <string_view>

#include "common/confinement/sandbox.hpp"
#include "common/error.hpp"
#include "mesh/gmsh_text.hpp"
#include "mesh/mesh_archive.hpp"
#include "mesh/own_readers.hpp"

namespace chladni::mesh {

namespace {

using Statements = std::vector<std::string>;

/// A .geo in memory that sets the parameters before it includes another one, and reads them
/// afterwards; Gmsh's own -setnumber would hold for the whole process. Gmsh 4.8.4 does not obey the
/// last statement of a file that it opens and whose last line does not end, but that of an included
/// one.
class GeoAround {
 public:
  explicit GeoAround(const MeshOptions& options)
      : descriptor_{::memfd_create("parameters", MFD_CLOEXEC)}
  {
    std::string code;
    for (const auto& [name, value] : options.parameters)
      code += fmt::format("{} = {:.17g};\n", name, value);
    code += fmt::format("Include \"{}\";\n", std::filesystem::absolute(*options.file).string());
    for (const auto& [name, value] : options.parameters)
      code += fmt::format("SetNumber(\"Chladni/{}\", {});\n", name, name);
    if (::write(descriptor_, code.data(), code.size()) != std::ssize(code))
      throw Error("cannot set the parameters of a .geo: no file in memory");
  }
  ~GeoAround() { ::close(descriptor_); }
  GeoAround(const GeoAround&) = delete;
  GeoAround& operator=(const GeoAround&) = delete;

  std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

 private:
  int descriptor_;
};

bool is_name(const std::string& text)
{
  const auto is_of_a_name = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) == 0 &&
         std::ranges::all_of(text, is_of_a_name);
}

/// Whether the file is included by another one, which needs its name as a text.
bool is_included(const MeshOptions& options, const std::string& text)
{
  return !options.parameters.empty() || !text.ends_with('\n');
}

/// What stands in GEO code must not end its text or its statement.
void check_can_be_included(const MeshOptions& options)
{
  for (const auto& [name, value] : options.parameters) {
    if (is_name(name)) continue;
    throw Error(
        fmt::format("mesh file {}: \"{}\" is no name of a parameter; a name has letters, "
                    "digits and underscores",
                    *options.file, name));
  }
  const auto breaks = [](unsigned char c) { return c == '"' || std::iscntrl(c) != 0; };
  if (std::ranges::none_of(std::filesystem::absolute(*options.file).string(), breaks)) return;
  throw Error(
      fmt::format("mesh file {}: a geometry with parameters, or without a line break at its end, "
                  "cannot stand in a folder with a quote or a control character in its name; "
                  "rename it",
                  *options.file));
}

/// @throws chladni::Error for a command that the process which reads a stranger's file cannot obey.
void check_commands(const std::string& file, const Statements& code)
{
  const std::string command = acting_command(code);
  if (command.empty()) return;
  throw Error(
      fmt::format("mesh file {}: its command {} would start a program or write a file; take "
                  "it out, or, if the file is your own, say --trust-mesh",
                  file, command));
}

void check_parameters_are_used(const MeshOptions& options, const Statements& code)
{
  for (const auto& [name, value] : options.parameters) {
    if (has_word(code, name) || has_word(code, "Include") || has_word(code, "Merge")) continue;
    throw Error(fmt::format("mesh file {} has no parameter {}", *options.file, name));
  }
}

void check_parameters_held(const MeshOptions& options)
{
  for (const auto& [name, value] : options.parameters) {
    std::vector<double> at_end;
    gmsh::onelab::getNumber("Chladni/" + name, at_end);
    if (at_end.size() == 1 && at_end[0] == value) continue;
    throw Error(fmt::format(
        "mesh file {} overwrites the parameter {} = {}; write DefineConstant[{} = ...] in it "
        "instead of an assignment",
        *options.file, name, value, name));
  }
}

/// @return a note, if the algorithm was replaced
std::vector<std::string> replace_algorithm_8(const Statements& code)
{
  double algorithm = 0.0;
  gmsh::option::getNumber("Mesh.Algorithm", algorithm);
  const bool of_a_surface = sets_algorithm_8_of_a_surface(code);
  if (algorithm != 8.0 && !of_a_surface) return {};
  gmsh::option::setNumber("Mesh.Algorithm", 6);
  std::vector<std::pair<int, int>> surfaces;
  if (of_a_surface) gmsh::model::getEntities(surfaces, 2);
  for (const auto& [dimension, tag] : surfaces) gmsh::model::mesh::setAlgorithm(dimension, tag, 6);
  return {"the .geo asks for Mesh.Algorithm 8, which crashes in Gmsh 4.8.4; it was meshed by 6"};
}

void check_does_not_mesh_itself(const std::string& file, const Statements& code)
{
  if (!has_mesh_command(code) || !sets_algorithm_8(code)) return;
  throw Error(
      fmt::format("mesh file {} meshes itself by Mesh.Algorithm 8, which crashes in Gmsh "
                  "4.8.4; take out its command \"Mesh 2;\" or use algorithm 6",
                  file));
}

}  // namespace

std::vector<std::string> open_geo(const MeshOptions& options)
{
  const std::string& file = *options.file;
  const std::string text = read_all(file);
  const Statements code = geo_statements(text);
  if (options.trust != Trust::owner) check_commands(file, code);
  if (is_included(options, text)) check_can_be_included(options);
  check_does_not_mesh_itself(file, code);
  check_parameters_are_used(options, code);
  gmsh::option::setNumber("Mesh.MeshSizeFactor", options.size_factor);
  if (is_included(options, text)) {
    const GeoAround around(options);
    gmsh::open(around.path());
    check_parameters_held(options);
  } else {
    gmsh::open(file);
  }
  return replace_algorithm_8(code);
}

namespace {

MeshSource source_of(const std::string& file)
{
  if (!std::filesystem::is_regular_file(file)) {
    throw Error(
        fmt::format("mesh file {} does not exist; give the path of a {}", file, extensions_of()));
  }
  if (const auto source = mesh_source(file)) return *source;
  throw Error(fmt::format("mesh file {}: its name must end with {}", file, extensions_of()));
}

/// Gmsh runs the code of NAME.opt before it is done with NAME.
void check_no_options_beside(const std::string& file)
{
  const std::string options = file + ".opt";
  if (!std::filesystem::exists(std::filesystem::symlink_status(options))) return;
  throw Error(
      fmt::format("mesh file {}: beside it is the option file {}, which Gmsh would obey; move that "
                  "away, or, if both files are your own, say --trust-mesh",
                  file, options));
}

/// What Gmsh complains of while it lives, which it tells nobody else.
class Complaints {
 public:
  Complaints() { gmsh::logger::start(); }
  ~Complaints() { gmsh::logger::stop(); }
  Complaints(const Complaints&) = delete;
  Complaints& operator=(const Complaints&) = delete;

  /// @throws chladni::Error with the first error, which has file and line.
  void refuse_errors() const
  {
    constexpr std::string_view error = "Error: ";
    std::vector<std::string> lines;
    gmsh::logger::get(lines);
    for (const std::string& line : lines)
      if (line.starts_with(error)) throw Error("Gmsh: " + line.substr(error.size()));
  }
};

/// Opens the file in Gmsh, with its groups.
/// @return notes for the user
std::vector<std::string> open(const MeshOptions& options, MeshSource source)
{
  if (options.trust != Trust::owner) check_no_options_beside(*options.file);
  if (source == MeshSource::msh) check_msh_is_whole(*options.file);
  if (source == MeshSource::step) return open_step(options);
  std::vector<std::string> notes;
  if (source == MeshSource::geo) {
    const Complaints complaints;
    notes = open_geo(options);
    complaints.refuse_errors();
  }
  if (source == MeshSource::msh) gmsh::open(*options.file);
  add_entity_groups(options);
  return notes;
}

}  // namespace

Mesh read_file(const MeshOptions& options, const std::function<void()>& before_reading)
{
  const MeshSource source = source_of(*options.file);
  if (has_own_reader(*options.file)) {
    before_reading();
    return read_here(options);
  }
  const int order = source == MeshSource::msh
                        ? 0
                        : options.element_order.value_or(options.solid_groups.empty() ? 3 : 2);
  const double unit = source == MeshSource::step ? 1e-3 : options.length_unit;
  std::vector<std::string> notes;
  const auto build = [&] {
    before_reading();
    notes = open(options, source);
    set_local_sizes(options, unit);
  };
  Mesh mesh = mesh_with_gmsh(build, order, options);
  mesh.notes.insert(mesh.notes.begin(), notes.begin(), notes.end());
  scale(mesh, unit);
  return mesh;
}

namespace {

namespace occ = gmsh::model::occ;

constexpr double mm = 1e-3;  // m

std::vector<Entity> entities_of(int dimension)
{
  std::vector<Entity> entities;
  gmsh::model::getEntities(entities, dimension);
  return entities;
}

/// 3 if a section of the scene is of solids.
int dimension_of_body(const MeshOptions& options)
{
  return options.solid_groups.empty() ? 2 : 3;
}

void check_content(const MeshOptions& options)
{
  const std::string& file = *options.file;
  const auto solids = entities_of(3);
  if (dimension_of_body(options) == 3) {
    if (!solids.empty()) return;
    throw Error(fmt::format("mesh file {} holds no solid, of which the section of \"{}\" is", file,
                            options.solid_groups.front()));
  }
  if (!solids.empty()) {
    throw Error(fmt::format(
        "mesh file {} holds {} solids: give sections of type = \"solid\" to \"volume_1\" "
        "and so on, or export the mid-surfaces as surfaces (shell or faces)",
        file, solids.size()));
  }
  if (entities_of(2).empty()) throw Error(fmt::format("mesh file {} has no surface", file));
}

/// Arcs between the nodes of a ring.
std::vector<Entity> add_ring_arcs(const RingOptions& ring)
{
  std::vector<Entity> arcs;
  for (int i = 0; i < ring.nodes; ++i) {
    const double step = 2.0 * std::numbers::pi / ring.nodes;
    arcs.emplace_back(1, occ::addCircle(0.0, 0.0, ring.z.value_or(0.0) / mm, ring.radius / mm, -1,
                                        i * step, (i + 1) * step));
  }
  return arcs;
}

/// Length, area or volume of an entity, and where it is.
struct Extent {
  double content;
  std::array<double, 3> centre;
};

Extent extent_of(const Entity& entity)
{
  Extent of{};
  occ::getMass(entity.first, entity.second, of.content);
  occ::getCenterOfMass(entity.first, entity.second, of.centre[0], of.centre[1], of.centre[2]);
  return of;
}

Extent sum_of(const std::vector<Entity>& parts)
{
  Extent sum{};
  for (const Entity& part : parts) {
    const Extent of = extent_of(part);
    sum.content += of.content;
    for (std::size_t c = 0; c < 3; ++c) sum.centre[c] += of.content * of.centre[c];
  }
  for (double& x : sum.centre) x /= sum.content > 0.0 ? sum.content : 1.0;
  return sum;
}

/// Whether two entities of a dimension are one, by what integrals over curved faces leave of them.
bool is_same(int dimension, const Extent& a, const Extent& b)
{
  constexpr double digits = 1e-3;
  const auto& [x, y, z] = a.centre;
  return std::abs(a.content - b.content) <= digits * a.content &&
         std::hypot(b.centre[0] - x, b.centre[1] - y, b.centre[2] - z) <=
             digits * std::pow(a.content, 1.0 / dimension);
}

/// Makes all volumes and surfaces meet in common surfaces and curves, with the rings' arcs among
/// them.
/// @return what became of each volume, surface and curve of the file
std::map<Entity, std::vector<Entity>> join(const std::vector<RingOptions>& rings)
{
  std::vector<Entity> objects;
  std::vector<Extent> extents;
  for (const int dimension : {3, 2, 1}) {
    const std::vector<Entity> entities = entities_of(dimension);
    objects.insert(objects.end(), entities.begin(), entities.end());
    std::ranges::transform(entities, std::back_inserter(extents), extent_of);
  }
  std::vector<Entity> tools;
  for (const RingOptions& ring : rings) {
    if (ring.on == RingOn::face) continue;
    const std::vector<Entity> arcs = add_ring_arcs(ring);
    tools.insert(tools.end(), arcs.begin(), arcs.end());
  }
  std::vector<Entity> all;
  std::vector<std::vector<Entity>> parts;
  occ::fragment(objects, tools, all, parts);
  occ::synchronize();
  std::array<std::vector<std::pair<Entity, Extent>>, 4> now;
  for (const int dimension : {3, 2, 1})
    for (const Entity& entity : entities_of(dimension))
      now[std::size_t(dimension)].emplace_back(entity, extent_of(entity));
  std::map<Entity, std::vector<Entity>> became;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const int dimension = objects[i].first;
    became[objects[i]] = parts[i];
    if (is_same(dimension, extents[i], sum_of(parts[i]))) continue;
    // Gmsh does not tell of what it left as it was, whose number may be that of another one now.
    const auto& candidates = now[std::size_t(dimension)];
    const auto same = std::ranges::find_if(
        candidates, [&](const auto& one) { return is_same(dimension, extents[i], one.second); });
    became[objects[i]].clear();
    if (same != candidates.end()) became[objects[i]].push_back(same->first);
  }
  return became;
}

/// Across the box of the body, from corner to corner, m.
double size_of_body()
{
  std::array<double, 3> low{}, high{};
  gmsh::model::getBoundingBox(-1, -1, low[0], low[1], low[2], high[0], high[1], high[2]);
  return mm * std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

void set_sizes(double element_size)
{
  constexpr double most_across = 1e4;
  const double least = size_of_body() / most_across;
  if (element_size < least) {
    throw Error(fmt::format(
        "mesh.element_size = {} m is too small for a body of {:.3g} m; take {:.1g} m or more",
        element_size, most_across * least, least));
  }
  gmsh::option::setNumber("Mesh.MeshSizeMax", element_size / mm);
  gmsh::option::setNumber("Mesh.MeshSizeMin", 0.02 * element_size / mm);
  // A cubic edge of 90 degrees folds its element over.
  gmsh::option::setNumber("Mesh.MinimumElementsPerTwoPi", 12);
  gmsh::option::setNumber("Mesh.MeshSizeFromCurvature", 1);
}

/// Groups of the file's entities, as what became of them; one for each volume, surface and curve
/// that is left, unless groups of this kind are given.
void add_groups(const MeshOptions& options, const std::vector<std::vector<Entity>>& of_groups,
                const std::map<Entity, std::vector<Entity>>& became)
{
  std::array<bool, 4> given{};
  for (std::size_t i = 0; i < options.groups.size(); ++i) {
    std::vector<Entity> parts;
    for (const Entity& entity : of_groups[i]) {
      const auto& p = became.at(entity);
      parts.insert(parts.end(), p.begin(), p.end());
    }
    if (parts.empty()) continue;
    given.at(parts.front().first) = true;
    add_entity_group(options.groups[i], parts, options);
  }
  for (const auto& [entity, parts] : became) {
    if (given.at(entity.first) || parts.empty()) continue;
    add_entity_group({.name = entity_name(entity), .entities = {}}, parts, options);
  }
}

/// Lets Gmsh mesh the second cut face of a sector, or cut edge of surfaces, as the turned first
/// one: sides of one body that a turn lays onto each other.
void match_cuts(const MeshOptions& options)
{
  const int dimension = dimension_of_body(options) - 1;
  std::vector<std::pair<int, Extent>> sides;
  for (const auto& [dim, tag] : entities_of(dimension)) {
    std::vector<int> above, below;
    gmsh::model::getAdjacencies(dim, tag, above, below);
    if (above.size() == 1) sides.emplace_back(tag, extent_of({dim, tag}));
  }
  const double turn = 2.0 * std::numbers::pi / options.sectors;
  const double c = std::cos(turn), s = std::sin(turn);
  for (const auto& [first, extent] : sides) {
    const auto& x = extent.centre;
    const Extent image{.content = extent.content,
                       .centre = {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]}};
    const auto second = std::ranges::find_if(
        sides, [&](const auto& other) { return is_same(dimension, image, other.second); });
    if (second == sides.end() || second->first == first) continue;
    gmsh::model::mesh::setPeriodic(dimension, {second->first}, {first},
                                   {c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  }
}

}  // namespace

std::vector<std::string> open_step(const MeshOptions& options)
{
  gmsh::option::setString("Geometry.OCCTargetUnit", "MM");
  gmsh::model::add("step");
  std::vector<Entity> imported;
  occ::importShapes(*options.file, imported, false, "step");
  occ::synchronize();
  check_content(options);
  std::vector<std::vector<Entity>> of_groups;
  for (const EntityGroup& group : options.groups) of_groups.push_back(find_entities(group));
  add_groups(options, of_groups, join(options.rings));
  if (options.element_size) set_sizes(*options.element_size);
  if (options.sectors > 1) match_cuts(options);
  return {};
}

namespace {

constexpr std::array<const char*, 4> prefixes{"point_", "curve_", "surface_", "volume_"};

std::string label_of(const Entity& entity)
{
  std::string label;
  gmsh::model::getEntityName(entity.first, entity.second, label);
  return label;
}

/// "Shapes/part/face" is found by its last part too.
bool has_label(const Entity& entity, const std::string& name)
{
  const std::string label = label_of(entity);
  return label == name || label.ends_with("/" + name);
}

std::string list(const std::vector<Entity>& entities)
{
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(entities.size(), 20); ++i) {
    const std::string label = label_of(entities[i]);
    text += fmt::format("{}{}{}", i == 0 ? "" : ", ", entity_name(entities[i]),
                        label.empty() ? "" : fmt::format(" ({})", label));
  }
  return text + (entities.size() > 20 ? ", ..." : "");
}

void check_ungrouped(const EntityGroup& group, const Entity& entity)
{
  std::vector<int> tags;
  gmsh::model::getPhysicalGroupsForEntity(entity.first, entity.second, tags);
  if (tags.empty()) return;
  std::string name;
  gmsh::model::getPhysicalName(entity.first, tags.front(), name);
  throw Error(fmt::format("group \"{}\": {} belongs to the group \"{}\" already", group.name,
                          entity_name(entity), name.empty() ? std::to_string(tags.front()) : name));
}

/// A .msh may list entities of which it holds no element.
bool is_without_elements(const Entity& entity)
{
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types, entity.first, entity.second);
  return types.empty();
}

bool is_meshed()
{
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types);
  return !types.empty();
}

void add_group_of_each(int dimension)
{
  std::vector<Entity> groups;
  gmsh::model::getPhysicalGroups(groups, dimension);
  if (!groups.empty()) return;
  std::vector<Entity> entities;
  gmsh::model::getEntities(entities, dimension);
  if (is_meshed()) std::erase_if(entities, is_without_elements);
  for (const Entity& e : entities) add_physical_group(dimension, {e.second}, entity_name(e));
}

}  // namespace

std::string entity_name(const Entity& entity)
{
  return prefixes.at(entity.first) + std::to_string(entity.second);
}

std::vector<Entity> find_entities(const EntityGroup& group)
{
  std::vector<Entity> all;
  gmsh::model::getEntities(all);
  std::vector<Entity> found;
  for (const std::string& name : group.entities) {
    const std::size_t before = found.size();
    for (const Entity& entity : all)
      if (entity_name(entity) == name || has_label(entity, name)) found.push_back(entity);
    if (found.size() > before) continue;
    std::ranges::reverse(all);  // volumes and surfaces first
    throw Error(fmt::format("group \"{}\": there is no entity \"{}\"; there are: {}", group.name,
                            name, list(all)));
  }
  const auto other = [&](const Entity& e) { return e.first != found.front().first; };
  if (std::ranges::any_of(found, other))
    throw Error(fmt::format("group \"{}\" mixes points, curves, surfaces and volumes", group.name));
  return found;
}

void add_entity_group(const EntityGroup& group, const std::vector<Entity>& entities,
                      const MeshOptions& options)
{
  std::vector<int> tags;
  for (const Entity& entity : entities) {
    if (entity.first == dimension_of_body(options)) check_ungrouped(group, entity);
    tags.push_back(entity.second);
  }
  std::ranges::sort(tags);
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  add_physical_group(entities.front().first, tags, group.name);
}

void add_groups_of_each_entity(const MeshOptions& options)
{
  if (dimension_of_body(options) == 3) add_group_of_each(3);
  add_group_of_each(2);
  add_group_of_each(1);
}

void add_entity_groups(const MeshOptions& options)
{
  for (const EntityGroup& group : options.groups)
    add_entity_group(group, find_entities(group), options);
  add_groups_of_each_entity(options);
}

namespace {

Mesh made(const MeshOptions& options, const std::function<void()>& before_reading)
{
  if (options.file) return read_file(options, before_reading);
  if (options.annulus) return unstructured_annulus(*options.annulus);
  if (options.hat_disc) return unstructured_hat_disc(*options.hat_disc);
  if (options.pad) return unstructured_patch(edges_of(*options.pad), patch_of(*options.pad));
  const RectangleOptions& rectangle = options.rectangle.value();
  return unstructured_patch(edges_of(rectangle), patch_of(rectangle));
}

}  // namespace

void answer(const std::string& subject, Unpacker& question, Packer& answer)
{
  const std::optional<confinement::Limits> limits = unpack_limits(question);
  MeshOptions options = unpack_options(question);
  options.trust = limits ? Trust::stranger : Trust::owner;
  const auto confine = [&] {
    if (limits) confinement::confine(*limits);
  };
  if (subject == "mesh") return pack(answer, made(options, confine));
  if (subject != "declarations") throw Error(fmt::format("nobody answers for \"{}\"", subject));
  DeckUnits units{};
  question(units.length);
  question(units.force);
  confine();
  pack(answer, declarations_here(options, units));
}

}  // namespace chladni::mesh
