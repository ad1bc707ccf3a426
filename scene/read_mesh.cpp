#include "scene/read_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

namespace chladni::scene {

namespace {

mesh::RingOptions read_ring(const Table& ring, const Admissible& radii)
{
  mesh::RingOptions options{.name = ring.text("name"),
                            .radius = ring.number("radius", radii),
                            .nodes = ring.integer("nodes")};
  if (ring.has("z")) options.z = ring.number("z");
  if (ring.has("on")) {
    options.on = ring.choice<mesh::RingOn>(
        "on", {{"nodes", mesh::RingOn::nodes}, {"face", mesh::RingOn::face}});
  }
  if (!ring.has("width")) return options;
  if (options.on != mesh::RingOn::face)
    ring.refuse("width", "is for rings with on = \"face\", whose nodes are means over faces");
  options.width =
      ring.number("width", {.at_most = 2.0 * options.radius, .unit = "m, the diameter"});
  return options;
}

std::string read_file_name(const Table& mesh, const std::string& scene_path)
{
  const std::filesystem::path file = mesh.text("file");
  if (!mesh::mesh_source(file.string())) {
    mesh.refuse("file", "must be a mesh file: " + mesh::extensions_with_programs() +
                            mesh::instead_of(file.string()));
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

/// The files of matrices, resolved against the folder of the scene, instead of sections.
std::optional<mesh::MatrixFiles> read_matrix_files(const Table& mesh, const std::string& scene_path)
{
  if (!mesh.has("matrices")) {
    check_only_for(mesh, "force_unit", false, "is of mesh.matrices");
    return std::nullopt;
  }
  for (const char* key : {"sectors", "coincident_nodes", "merge_tolerance", "doubled_elements"})
    check_only_for(mesh, key, false, "changes nodes or elements, and the matrices are as they are");
  const Table table = mesh.table("matrices");
  const auto file = [&](const char* key, const std::string& named) {
    const auto path = std::filesystem::path(scene_path).parent_path() / named;
    if (!std::filesystem::is_regular_file(path)) table.refuse(key, "is no file beside the scene");
    return path.lexically_normal().string();
  };
  mesh::MatrixFiles files{.stiffness = file("stiffness", table.text("stiffness")),
                          .mass = file("mass", table.text("mass"))};
  if (table.has("damping")) files.damping = file("damping", table.text("damping"));
  if (table.has("structural_damping"))
    files.structural_damping = file("structural_damping", table.text("structural_damping"));
  if (table.has("dofs")) files.dofs = file("dofs", table.text("dofs"));
  const bool is_inch = mesh.has("length_unit") && mesh.text("length_unit") == "inch";
  files.force_unit = is_inch ? mesh::pound_force : 1.0;
  if (mesh.has("force_unit")) {
    files.force_unit = mesh.choice<double>(
        "force_unit", {{"N", 1.0}, {"mN", 1e-3}, {"kN", 1e3}, {"lbf", mesh::pound_force}});
  }
  return files;
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
  check_only_for(mesh, "length_unit", !is_step, "a .step file contains its unit");
  if (mesh.has("element_order")) options.element_order = read_element_order(mesh);
  if (is_step) options.element_size = read_size_of_step(mesh, size);
  if (mesh.has("parameters")) options.parameters = read_parameters(mesh);
  if (mesh.has("length_unit") || is_finished) options.length_unit = read_length_unit(mesh);
  if (mesh.has("groups")) options.groups = read_entity_groups(mesh);
  options.matrices = read_matrix_files(mesh, scene_path);
  options.sectors = read_sectors(mesh);
  if (options.matrices) options.coincident_nodes = mesh::Coincident::keep;
  if (mesh.has("coincident_nodes")) options.coincident_nodes = read_coincident_nodes(mesh);
  if (mesh.has("doubled_elements")) options.doubled_elements = read_doubled_elements(mesh);
  if (mesh.has("merge_tolerance")) options.merge_tolerance = mesh.number("merge_tolerance");
  std::vector<std::string> taken;
  for (const mesh::EntityGroup& group : options.groups) taken.push_back(group.name);
  options.rings = read_rings(mesh, taken, {.above = 0.0, .unit = "m"});
  return options;
}

/// Nodes on faces are found on whole bodies alone.
void refuse_sectors_of_faces(const Table& mesh, const std::vector<mesh::RingOptions>& rings)
{
  if (!mesh.has("sectors") || (!finds_sectors(mesh) && read_sectors(mesh) == 1)) return;
  for (const mesh::RingOptions& ring : rings) {
    if (ring.on == mesh::RingOn::nodes) continue;
    mesh.refuse("sectors",
                "ring \"" + ring.name +
                    "\" is on a face, and those of sectors need nodes of the mesh at its "
                    "places; take the whole body, or out on = \"face\"");
  }
}

mesh::SectorSearch read_sector_search(const Table& root, const Table& mesh)
{
  if (mesh.has("sectors"))
    return finds_sectors(mesh) ? mesh::SectorSearch::asked : mesh::SectorSearch::none;
  return root.has("accuracy") ? mesh::SectorSearch::where_nothing_is_lost
                              : mesh::SectorSearch::none;
}

/// The mesh of solids is the scene's, whose error `accuracy` estimates.
bool has_solids(const Table& root)
{
  if (!root.has("section")) return false;
  return std::ranges::any_of(root.tables("section"), [](const Table& section) {
    return section.has("type") && section.is_text("type") && section.text("type") == "solid";
  });
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
  const Size size = root.has("accuracy") && !has_solids(root) ? Size::chosen : Size::given;
  const bool is_file = mesh.only_one_of({"generator", "file"}) == "file";
  mesh::MeshOptions options =
      is_file ? read_file(mesh, size, scene_path) : read_generator(mesh, size);
  if ((options.file && !options.matrices) || options.annulus || options.hat_disc)
    options.sector_search = read_sector_search(root, mesh);
  refuse_sectors_of_faces(mesh, rings_of(options));
  if (std::ranges::count(rings_of(options), mesh::RingOn::face, &mesh::RingOptions::on) > 0)
    options.sector_search = mesh::SectorSearch::none;
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

namespace {

constexpr double degree = std::numbers::pi / 180.0;

mesh::Pattern read_pattern(const Table& mesh, mesh::Pattern otherwise)
{
  if (!mesh.has("pattern")) return otherwise;
  return mesh.choice<mesh::Pattern>("pattern", {{"structured", mesh::Pattern::structured},
                                                {"unstructured", mesh::Pattern::unstructured},
                                                {"triangles", mesh::Pattern::triangles}});
}

std::optional<double> read_edge_row(const Table& mesh, double width)
{
  if (!mesh.has("edge_row")) return std::nullopt;
  return mesh.number("edge_row",
                     {.above = 0.0, .below = 0.5 * width, .unit = "m, half of the width"});
}

void refuse_chosen(const Table& mesh, const char* key)
{
  if (mesh.has(key)) mesh.refuse(key, "`accuracy` chooses it; take this key out");
}

/// For a body of this width (m) and area (m^2), of ten million elements at most; 0 where it is to
/// be chosen.
double read_element_size(const Table& mesh, Size size, double width, double area)
{
  if (size == Size::chosen) {
    refuse_chosen(mesh, "element_size");
    return 0.0;
  }
  constexpr double most_elements = 1e7;
  return mesh.number("element_size", {.at_least = std::sqrt(area / most_elements),
                                      .at_most = width,
                                      .unit = "m, from 10 million elements up to the width"});
}

/// m^2
double area_of_ring(double inner_radius, double outer_radius)
{
  return std::numbers::pi * (outer_radius * outer_radius - inner_radius * inner_radius);
}

double read_outer_radius(const Table& mesh, double inner_radius)
{
  return mesh.number("outer_radius", {.above = inner_radius, .unit = "m, the inner radius"});
}

void refuse_free_pattern(const Table& mesh, int sectors, mesh::Pattern pattern)
{
  if (sectors == 1 || pattern == mesh::Pattern::structured) return;
  mesh.refuse("sectors", "needs pattern = \"structured\": Gmsh's elements differ between sectors");
}

mesh::AnnulusOptions read_annulus(const Table& mesh, Size size)
{
  mesh::AnnulusOptions annulus{};
  annulus.inner_radius = mesh.number("inner_radius");
  annulus.outer_radius = read_outer_radius(mesh, annulus.inner_radius);
  const double width = annulus.outer_radius - annulus.inner_radius;
  annulus.element_size = read_element_size(
      mesh, size, width, area_of_ring(annulus.inner_radius, annulus.outer_radius));
  if (mesh.has("element_order")) annulus.element_order = read_element_order(mesh);
  annulus.sectors = read_sectors(mesh);
  annulus.pattern =
      read_pattern(mesh, annulus.sectors > 1 || finds_sectors(mesh) || size == Size::chosen
                             ? mesh::Pattern::structured
                         : mesh.has("extrude") ? mesh::Pattern::structured
                                               : mesh::Pattern::unstructured);
  refuse_free_pattern(mesh, annulus.sectors, annulus.pattern);
  annulus.edge_row = read_edge_row(mesh, width);
  annulus.rings = read_rings(mesh, generated_groups({.annulus = annulus}),
                             {.above = annulus.inner_radius,
                              .below = annulus.outer_radius,
                              .unit = "m, between the edges of the annulus"});
  return annulus;
}

std::optional<mesh::BoltOptions> read_bolts(const Table& mesh, const mesh::HatDiscOptions& hat)
{
  if (!mesh.has("bolts")) return std::nullopt;
  if (hat.pattern == mesh::Pattern::structured)
    mesh.refuse("bolts", "holes need pattern = \"unstructured\" or \"triangles\"");
  const Table bolts = mesh.table("bolts");
  return mesh::BoltOptions{
      .count = bolts.integer("count"),
      .circle_radius = bolts.number(
          "circle_radius",
          {.above = hat.hub_radius, .below = hat.top_radius, .unit = "m, on the flange"}),
      .hole_radius = bolts.number("hole_radius")};
}

mesh::HatDiscOptions read_hat_disc(const Table& mesh, Size size)
{
  mesh::HatDiscOptions hat{};
  hat.wall_radius = mesh.number("wall_radius");
  hat.outer_radius =
      mesh.number("outer_radius", {.above = hat.wall_radius, .unit = "m, the wall's radius"});
  const auto or_wall = [&](const char* key, const Admissible& admissible) {
    return mesh.has(key) ? mesh.number(key, admissible) : hat.wall_radius;
  };
  hat.inner_radius =
      or_wall("inner_radius", {.above = 0.0, .at_most = hat.wall_radius, .unit = "m"});
  hat.top_radius = or_wall("top_radius", {.above = 0.0, .unit = "m"});
  hat.hub_radius = mesh.number("hub_radius", {.above = 0.0, .below = hat.top_radius, .unit = "m"});
  hat.height = mesh.number("height");
  if (mesh.has("foot"))
    hat.foot = mesh.number("foot", {.at_least = 0.0, .below = hat.height, .unit = "m"});
  const double width = hat.outer_radius - hat.wall_radius;
  hat.element_size =
      read_element_size(mesh, size, width, area_of_ring(hat.wall_radius, hat.outer_radius));
  if (mesh.has("element_order")) hat.element_order = read_element_order(mesh);
  hat.pattern = read_pattern(
      mesh, mesh.has("bolts") ? mesh::Pattern::unstructured : mesh::Pattern::structured);
  hat.sectors = read_sectors(mesh);
  refuse_free_pattern(mesh, hat.sectors, hat.pattern);
  hat.edge_row = read_edge_row(mesh, width);
  hat.bolts = read_bolts(mesh, hat);
  hat.rings = read_rings(mesh, generated_groups({.hat_disc = hat}),
                         {.above = hat.wall_radius,
                          .below = hat.outer_radius,
                          .unit = "m, between the wall and the outer edge"});
  return hat;
}

mesh::PadOptions read_pad_mesh(const Table& mesh, Size size)
{
  mesh::PadOptions pad{};
  pad.inner_radius = mesh.number("inner_radius");
  pad.outer_radius = read_outer_radius(mesh, pad.inner_radius);
  pad.angle = degree * mesh.number("angle_deg");
  if (mesh.has("centre_deg")) pad.centre_angle = degree * mesh.number("centre_deg");
  const double length = 0.5 * (pad.inner_radius + pad.outer_radius) * pad.angle;
  const double width = std::min(pad.outer_radius - pad.inner_radius, length);
  pad.element_size =
      read_element_size(mesh, size, width, length * (pad.outer_radius - pad.inner_radius));
  if (mesh.has("element_order")) pad.element_order = read_element_order(mesh);
  pad.pattern = read_pattern(mesh, mesh::Pattern::structured);
  pad.edge_row = read_edge_row(mesh, width);
  return pad;
}

mesh::RectangleOptions read_rectangle(const Table& mesh, Size size)
{
  mesh::RectangleOptions plate{};
  plate.length = mesh.number("length");
  plate.width = mesh.number("width");
  const double width = std::min(plate.length, plate.width);
  plate.element_size = read_element_size(mesh, size, width, plate.length * plate.width);
  if (mesh.has("element_order")) plate.element_order = read_element_order(mesh);
  plate.pattern = read_pattern(mesh, mesh::Pattern::structured);
  plate.edge_row = read_edge_row(mesh, width);
  return plate;
}

std::vector<mesh::BeamPoint> read_points(const Table& mesh, double length)
{
  std::set<std::string> taken{"beam", "start", "end"};
  std::vector<mesh::BeamPoint> points;
  if (!mesh.has("points")) return points;
  constexpr double digits = 1e-9;  // that a length written by hand may lack
  const Admissible distances{.at_least = 0.0, .at_most = length, .unit = "m, along the beam"};
  for (const Table& table : mesh.tables("points")) {
    const bool is_end = std::abs(table.number("distance") - length) < digits * length;
    points.push_back({.name = table.text("name"),
                      .distance = is_end ? length : table.number("distance", distances)});
    if (!taken.insert(points.back().name).second)
      table.refuse("name", "is the name of another point or group of the mesh");
  }
  return points;
}

mesh::BeamMeshOptions read_beam(const Table& mesh, Size size)
{
  mesh::BeamMeshOptions beam{.start = read_vector(mesh, "start"), .end = read_vector(mesh, "end")};
  const double length = std::hypot(beam.end[0] - beam.start[0], beam.end[1] - beam.start[1],
                                   beam.end[2] - beam.start[2]);
  if (!(length > 0.0)) mesh.refuse("end", "is the start of the beam too");
  if (size == Size::chosen) {
    for (const char* key : {"elements", "element_size"}) refuse_chosen(mesh, key);
    beam.element_size = 0.0;
  } else if (mesh.only_one_of({"elements", "element_size"}) == "elements") {
    beam.elements = mesh.integer("elements");
  } else {
    beam.element_size =
        mesh.number("element_size",
                    {.at_least = 1e-6 * length, .at_most = length, .unit = "m, up to the length"});
  }
  beam.points = read_points(mesh, length);
  if (mesh.has("element_order")) beam.element_order = read_element_order(mesh);
  return beam;
}

std::vector<std::string> beam_groups(const mesh::BeamMeshOptions& beam)
{
  std::vector<std::string> names{"beam", "start", "end"};
  for (const mesh::BeamPoint& point : beam.points) names.push_back(point.name);
  return names;
}

std::vector<std::string> hat_disc_groups(const mesh::HatDiscOptions& hat)
{
  std::vector<std::string> names{"disc", "wall", "flange", "outer_edge", "wall_seat", "hub_edge"};
  if (hat.inner_radius < hat.wall_radius) names.emplace_back("inner_edge");
  if (hat.foot > 0.0) names.emplace_back("wall_foot");
  for (int i = 1; hat.bolts && i <= hat.bolts->count; ++i)
    names.push_back("bolt_" + std::to_string(i));
  if (hat.bolts) names.emplace_back("bolt_edges");
  return names;
}

}  // namespace

namespace {

std::optional<mesh::Extrusion> read_extrusion(const Table& mesh, const mesh::MeshOptions& options)
{
  const auto* const rings = options.annulus ? &options.annulus->rings : nullptr;
  if (!mesh.has("extrude")) return std::nullopt;
  if (!options.annulus && !options.pad && !options.rectangle)
    mesh.refuse("extrude", "is for the plane generators annulus, pad and rectangle");
  const Table table = mesh.table("extrude");
  mesh::Extrusion extrusion{.from = table.number("from"), .to = 0.0};
  extrusion.to = table.number("to", {.above = extrusion.from, .unit = "m, `from`"});
  if (table.has("layers")) extrusion.layers = table.integer("layers");
  if (rings == nullptr) return extrusion;
  for (const mesh::RingOptions& ring : *rings)
    if (ring.z && (*ring.z < extrusion.from || *ring.z > extrusion.to))
      mesh.refuse("rings", "\"" + ring.name + "\": its z is not between those of `extrude`");
  return extrusion;
}

}  // namespace

mesh::MeshOptions read_generator(const Table& mesh, Size size)
{
  using Read = void (*)(const Table&, Size, mesh::MeshOptions&);
  const Read read = mesh.choice<Read>(
      "generator",
      {{"annulus",
        [](const Table& t, Size s, mesh::MeshOptions& o) { o.annulus = read_annulus(t, s); }},
       {"hat_disc",
        [](const Table& t, Size s, mesh::MeshOptions& o) { o.hat_disc = read_hat_disc(t, s); }},
       {"pad", [](const Table& t, Size s, mesh::MeshOptions& o) { o.pad = read_pad_mesh(t, s); }},
       {"rectangle",
        [](const Table& t, Size s, mesh::MeshOptions& o) { o.rectangle = read_rectangle(t, s); }},
       {"beam", [](const Table& t, Size s, mesh::MeshOptions& o) { o.beam = read_beam(t, s); }}});
  mesh::MeshOptions options;
  read(mesh, size, options);
  options.extrude = read_extrusion(mesh, options);
  return options;
}

std::vector<std::string> generated_groups(const mesh::MeshOptions& mesh)
{
  if (mesh.extrude) {
    mesh::MeshOptions flat = mesh;
    flat.extrude.reset();
    std::vector<std::string> names = generated_groups(flat);
    names.insert(names.end(), {"bottom_face", "top_face"});
    return names;
  }
  if (mesh.annulus) return {"disc", "inner_edge", "outer_edge"};
  if (mesh.hat_disc) return hat_disc_groups(*mesh.hat_disc);
  if (mesh.pad) return {"pad", "inner_edge", "outer_edge", "first_edge", "last_edge", "corners"};
  if (mesh.rectangle) return {"plate", "left", "right", "bottom", "top", "corners"};
  if (mesh.beam) return beam_groups(*mesh.beam);
  return {};
}

std::vector<std::string> surface_groups(const mesh::MeshOptions& mesh)
{
  if (mesh.annulus) return {"disc"};
  if (mesh.hat_disc) return {"disc", "wall", "flange"};
  if (mesh.pad) return {"pad"};
  if (mesh.rectangle) return {"plate"};
  if (mesh.beam) return {"beam"};
  return {};
}

}  // namespace chladni::scene
