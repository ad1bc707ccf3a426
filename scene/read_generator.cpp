#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "scene/read_mesh_parts.hpp"

namespace chladni::scene {
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

mesh::PadOptions read_pad(const Table& mesh, Size size)
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

mesh::MeshOptions read_generator(const Table& mesh, Size size)
{
  using Read = void (*)(const Table&, Size, mesh::MeshOptions&);
  const Read read = mesh.choice<Read>(
      "generator",
      {{"annulus",
        [](const Table& t, Size s, mesh::MeshOptions& o) { o.annulus = read_annulus(t, s); }},
       {"hat_disc",
        [](const Table& t, Size s, mesh::MeshOptions& o) { o.hat_disc = read_hat_disc(t, s); }},
       {"pad", [](const Table& t, Size s, mesh::MeshOptions& o) { o.pad = read_pad(t, s); }},
       {"rectangle",
        [](const Table& t, Size s, mesh::MeshOptions& o) { o.rectangle = read_rectangle(t, s); }},
       {"beam", [](const Table& t, Size s, mesh::MeshOptions& o) { o.beam = read_beam(t, s); }}});
  mesh::MeshOptions options;
  read(mesh, size, options);
  return options;
}

std::vector<std::string> generated_groups(const mesh::MeshOptions& mesh)
{
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
