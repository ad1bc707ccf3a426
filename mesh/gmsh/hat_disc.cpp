#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/curved_rows.hpp"
#include "mesh/gmsh/circles.hpp"
#include "mesh/gmsh/generators.hpp"
#include "mesh/gmsh/model.hpp"

namespace chladni::mesh {

namespace {

/// Surfaces and edges of the model in Gmsh.
struct HatModel {
  std::vector<Circle> disc;  ///< ascending by radius
  Circle seat, foot, top, hub;
  std::vector<Circle> bolts;
  std::vector<Circle> bolt_rows;  ///< around the bolts, where there are edge rows
};

std::vector<Circle> disc_circles(const HatDiscOptions& o, const Circle& seat)
{
  const double h = o.element_size;
  const bool has_inner_edge = o.inner_radius < o.wall_radius;
  std::vector<Circle> circles{seat, add_circle({.radius = o.outer_radius}, h)};
  if (o.edge_row) {
    const Circle outer = circles.back();
    circles.push_back(add_circle({.radius = o.outer_radius - *o.edge_row}, outer));
  }
  if (has_inner_edge) circles.push_back(add_circle({.radius = o.inner_radius}, h));
  if (has_inner_edge && o.edge_row) {
    const Circle inner = circles.back();
    circles.push_back(add_circle({.radius = o.inner_radius + *o.edge_row}, inner));
  }
  for (const RingOptions& ring : o.rings)
    circles.push_back(add_circle({.radius = ring.radius, .n_arcs = ring.nodes}, h));
  std::ranges::sort(circles, {}, &Circle::radius);
  return circles;
}

void add_bolts(const HatDiscOptions& o, HatModel& hat)
{
  for (int i = 0; o.bolts && i < o.bolts->count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / o.bolts->count;
    CirclePlace place{.radius = o.bolts->hole_radius,
                      .centre = {o.bolts->circle_radius * std::cos(angle),
                                 o.bolts->circle_radius * std::sin(angle), o.height}};
    hat.bolts.push_back(add_circle(place, o.element_size));
    if (!o.edge_row) continue;
    place.radius += *o.edge_row;
    hat.bolt_rows.push_back(add_circle(place, hat.bolts.back()));
  }
}

HatModel add_circles(const HatDiscOptions& o)
{
  const double h = o.element_size;
  const auto at = [&](double radius, double z) {
    return CirclePlace{.radius = radius, .centre = {0.0, 0.0, z}};
  };
  HatModel hat;
  hat.seat = add_circle(at(o.wall_radius, 0.0), h);
  hat.disc = disc_circles(o, hat.seat);
  hat.foot = o.foot > 0.0 ? add_circle(at(o.wall_radius, o.foot), hat.seat) : hat.seat;
  hat.top = add_circle(at(o.top_radius, o.height), hat.seat);
  hat.hub = add_circle(at(o.hub_radius, o.height), h);
  add_bolts(o, hat);
  return hat;
}

std::vector<int> add_flange(const HatDiscOptions& o, const HatModel& hat)
{
  std::vector<Circle> holes = o.edge_row ? hat.bolt_rows : hat.bolts;
  if (!o.edge_row) {
    holes.push_back(hat.hub);
    return {add_plane(hat.top, holes)};
  }
  const Circle row =
      add_circle({.radius = o.hub_radius + *o.edge_row, .centre = {0.0, 0.0, o.height}}, hat.hub);
  std::vector<int> surfaces = add_rows(hat.hub, row, o.element_size);
  holes.push_back(row);
  for (std::size_t i = 0; i < hat.bolts.size(); ++i) {
    const std::vector<int> of_bolt = add_rows(hat.bolts[i], hat.bolt_rows[i], o.element_size);
    surfaces.insert(surfaces.end(), of_bolt.begin(), of_bolt.end());
  }
  surfaces.push_back(add_plane(hat.top, holes));
  return surfaces;
}

void name_edges(const HatDiscOptions& o, const HatModel& hat)
{
  if (o.inner_radius < o.wall_radius) add_physical_group(1, hat.disc.front().arcs, "inner_edge");
  add_physical_group(1, hat.disc.back().arcs, "outer_edge");
  add_physical_group(1, hat.seat.arcs, "wall_seat");
  if (o.foot > 0.0) add_physical_group(1, hat.foot.arcs, "wall_foot");
  add_physical_group(1, hat.hub.arcs, "hub_edge");
  std::vector<int> all;
  for (std::size_t i = 0; i < hat.bolts.size(); ++i) {
    add_physical_group(1, hat.bolts[i].arcs, fmt::format("bolt_{}", i + 1));
    all.insert(all.end(), hat.bolts[i].arcs.begin(), hat.bolts[i].arcs.end());
  }
  if (!all.empty()) add_physical_group(1, all, "bolt_edges");
}

std::vector<CurvedRow> edge_rows(const HatDiscOptions& o)
{
  const double row = *o.edge_row;
  std::vector<CurvedRow> rows{
      {.centre = {}, .inner = o.outer_radius - row, .outer = o.outer_radius},
      {.centre = {}, .inner = o.inner_radius, .outer = o.inner_radius + row},
      {.centre = {}, .inner = o.hub_radius, .outer = o.hub_radius + row}};
  for (int i = 0; o.bolts && i < o.bolts->count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / o.bolts->count;
    const double c = o.bolts->circle_radius, hole = o.bolts->hole_radius;
    rows.push_back(
        {.centre = {c * std::cos(angle), c * std::sin(angle)}, .inner = hole, .outer = hole + row});
  }
  return rows;
}

}  // namespace

Mesh unstructured_hat_disc(const HatDiscOptions& o)
{
  const auto build = [&] {
    gmsh::model::add("hat_disc");
    set_element_size(o.element_size, o.pattern);
    const HatModel hat = add_circles(o);
    const auto disc = add_rings_of_elements(hat.disc, o.element_size, o.edge_row.value_or(0.0));
    const auto wall = add_rows(hat.top, hat.foot, o.element_size);
    const auto flange = add_flange(o, hat);
    gmsh::model::geo::synchronize();
    name_edges(o, hat);
    add_physical_group(2, disc, "disc");
    add_physical_group(2, wall, "wall");
    add_physical_group(2, flange, "flange");
  };
  Mesh mesh = mesh_with_gmsh(build, o.element_order);
  if (o.edge_row) bend_triangles(mesh, edge_rows(o));
  return mesh;
}

}  // namespace chladni::mesh
