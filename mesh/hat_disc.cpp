#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "mesh/circles.hpp"
#include "mesh/curved_rows.hpp"
#include "mesh/generators.hpp"
#include "mesh/gmsh_model.hpp"
#include "mesh/rings.hpp"
#include "mesh/sectors.hpp"
#include "mesh/structured_disc.hpp"
#include "mesh/sweep.hpp"

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

/// @throws chladni::Error unless the numbers ascend, with their names.
void check_ascending(const std::vector<std::pair<const char*, double>>& lengths)
{
  for (std::size_t i = 0; i + 1 < lengths.size(); ++i) {
    if (lengths[i].second < lengths[i + 1].second) continue;
    throw Error(fmt::format("hat_disc: {} = {} m must be less than {} = {} m", lengths[i].first,
                            lengths[i].second, lengths[i + 1].first, lengths[i + 1].second));
  }
}

void check_rings(const HatDiscOptions& o)
{
  const double row = o.edge_row.value_or(0.0);
  for (const RingOptions& ring : o.rings) {
    if (ring.radius > o.wall_radius && ring.radius < o.outer_radius - row) continue;
    throw Error(
        fmt::format("hat_disc: ring \"{}\" of radius {} m is not on the disc between the "
                    "wall and the outer edge with its row, {} and {:.6g} m",
                    ring.name, ring.radius, o.wall_radius, o.outer_radius - row));
  }
}

void check_bolts(const HatDiscOptions& o)
{
  if (!o.bolts) return;
  if (o.pattern == Pattern::structured)
    throw Error("hat_disc: bolts need pattern = \"unstructured\" or \"triangles\"");
  const double c = o.bolts->circle_radius;
  const double r = o.bolts->hole_radius + o.edge_row.value_or(0.0);
  check_ascending({{"0", 0.0}, {"bolts.hole_radius", o.bolts->hole_radius}});
  check_ascending(
      {{"bolts.hole_radius with its row", r},
       {"half the distance of two bolts", c * std::sin(std::numbers::pi / o.bolts->count)}});
  check_ascending({{"hub_radius with its row", o.hub_radius + o.edge_row.value_or(0.0)},
                   {"the inmost point of a bolt's hole", c - r},
                   {"its outmost point", c + r},
                   {"top_radius", o.top_radius}});
}

void check(const HatDiscOptions& o)
{
  check_ascending({{"0", 0.0}, {"hub_radius", o.hub_radius}, {"top_radius", o.top_radius}});
  check_ascending({{"0", 0.0}, {"wall_radius", o.wall_radius}, {"outer_radius", o.outer_radius}});
  check_ascending({{"foot", o.foot}, {"height", o.height}});
  if (!(o.foot >= 0.0)) throw Error(fmt::format("hat_disc: foot = {} m is below the disc", o.foot));
  if (!(o.inner_radius > 0.0 && o.inner_radius <= o.wall_radius)) {
    throw Error(
        fmt::format("hat_disc: inner_radius = {} m must be > 0 and at most wall_radius = "
                    "{} m",
                    o.inner_radius, o.wall_radius));
  }
  if (o.edge_row) {
    check_edge_rows(*o.edge_row, o.outer_radius - o.wall_radius);
    check_edge_rows(*o.edge_row, o.top_radius - o.hub_radius);
    if (o.inner_radius < o.wall_radius)
      check_edge_rows(*o.edge_row, o.wall_radius - o.inner_radius);
  }
  check_rings(o);
  check_bolts(o);
  check_pattern_of_sectors(o.sectors, o.pattern);
}

}  // namespace

Mesh hat_disc(const HatDiscOptions& options)
{
  check(options);
  Mesh mesh = options.pattern == Pattern::structured ? structured_hat_disc(options)
                                                     : unstructured_hat_disc(options);
  std::vector<RingOptions> rings = options.rings;
  for (RingOptions& ring : rings) ring.z = 0.0;
  add_rings(mesh, rings);
  return mesh;
}

}  // namespace chladni::mesh
