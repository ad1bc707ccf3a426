#include "mesh/generators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/error.hpp"
#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"
#include "mesh/mesher.hpp"
#include "mesh/sectors.hpp"
#include "mesh/sweep.hpp"

namespace chladni::mesh {

namespace {

/// An annular disc of rows and columns, without the groups of its rings.
Mesh structured_annulus(const AnnulusOptions& options);

/// A disc with hat of rows and columns, without the groups of its rings.
Mesh structured_hat_disc(const HatDiscOptions& options);

/// Around the z axis, or over the first of equal sectors.
/// @throws chladni::Error when the elements around do not divide among the sectors.
Path turn(int n_elements, int order, int sectors)
{
  if (n_elements % sectors != 0) {
    throw Error(
        fmt::format("sectors = {} does not divide the {} elements around the disc; take a "
                    "divisor, or another element_size",
                    sectors, n_elements));
  }
  const auto position = [sectors](const Station& s, double t) {
    const double angle = 2.0 * std::numbers::pi * t / sectors;
    return std::array{s[0] * std::cos(angle), s[0] * std::sin(angle), s[1]};
  };
  return {.n_elements = n_elements / sectors,
          .closed = sectors == 1,
          .order = order,
          .position = position};
}

Profile level(const std::string& group, const std::vector<double>& radii, double z)
{
  Profile profile{.group = group, .stations = {}};
  for (const double r : radii) profile.stations.push_back({r, z});
  return profile;
}

/// From the flange down to the disc, so that its normal points outwards.
Profile wall_profile(const HatDiscOptions& o)
{
  const double slant = std::hypot(o.wall_radius - o.top_radius, o.height - o.foot);
  Profile profile{.group = "wall", .stations = {}};
  for (const double s : cut({0.0, slant}, o.element_size)) {
    const double part = s / slant;
    profile.stations.push_back({o.top_radius + part * (o.wall_radius - o.top_radius),
                                o.height + part * (o.foot - o.height)});
  }
  profile.stations.back() = {o.wall_radius, o.foot};
  return profile;
}

std::vector<double> disc_radii(const AnnulusOptions& o)
{
  std::vector<double> radii{o.inner_radius, o.outer_radius};
  for (const RingOptions& ring : o.rings) radii.push_back(ring.radius);
  return o.edge_row ? with_edge_rows(radii, *o.edge_row) : radii;
}

std::vector<double> disc_radii(const HatDiscOptions& o)
{
  std::vector<double> radii{o.inner_radius, o.outer_radius, o.wall_radius};
  for (const RingOptions& ring : o.rings) radii.push_back(ring.radius);
  if (!o.edge_row) return radii;
  if (o.inner_radius < o.wall_radius) return with_edge_rows(radii, *o.edge_row);
  radii.push_back(o.outer_radius - *o.edge_row);
  return radii;
}

std::vector<double> flange_radii(const HatDiscOptions& o)
{
  std::vector<double> radii{o.hub_radius, o.top_radius};
  if (o.edge_row) radii.push_back(o.hub_radius + *o.edge_row);
  return radii;
}

Mesh structured_annulus(const AnnulusOptions& o)
{
  const double h = o.element_size;
  const int n = n_elements_around(o.outer_radius, h, o.rings, o.sectors);
  const std::vector<Profile> profiles{level("disc", cut(disc_radii(o), h), 0.0)};
  Swept swept = sweep(profiles, turn(n, o.element_order, o.sectors));
  add_row_group(swept, {o.inner_radius, 0.0}, "inner_edge");
  add_row_group(swept, {o.outer_radius, 0.0}, "outer_edge");
  find_sector_edges(swept.mesh, o.sectors);
  return swept.mesh;
}

Mesh structured_hat_disc(const HatDiscOptions& o)
{
  const double h = o.element_size;
  const int n = n_elements_around(o.outer_radius, h, o.rings, o.sectors);
  const std::vector<Profile> profiles{level("disc", cut(disc_radii(o), h), 0.0), wall_profile(o),
                                      level("flange", cut(flange_radii(o), h), o.height)};
  Swept swept = sweep(profiles, turn(n, o.element_order, o.sectors));
  if (o.inner_radius < o.wall_radius) add_row_group(swept, {o.inner_radius, 0.0}, "inner_edge");
  add_row_group(swept, {o.outer_radius, 0.0}, "outer_edge");
  add_row_group(swept, {o.wall_radius, 0.0}, "wall_seat");
  if (o.foot > 0.0) add_row_group(swept, {o.wall_radius, o.foot}, "wall_foot");
  add_row_group(swept, {o.hub_radius, o.height}, "hub_edge");
  find_sector_edges(swept.mesh, o.sectors);
  return swept.mesh;
}

void check_radii(const AnnulusOptions& o)
{
  if (!(o.inner_radius > 0.0 && o.inner_radius < o.outer_radius)) {
    throw Error(fmt::format("annulus: 0 < inner_radius < outer_radius must hold, not {} and {} m",
                            o.inner_radius, o.outer_radius));
  }
  if (o.edge_row) check_edge_rows(*o.edge_row, o.outer_radius - o.inner_radius);
  check_pattern_of_sectors(o.sectors, o.pattern);
  const double row = o.edge_row.value_or(0.0);
  for (const RingOptions& ring : o.rings) {
    if (!(ring.radius > o.inner_radius + row && ring.radius < o.outer_radius - row)) {
      throw Error(
          fmt::format("annulus: ring \"{}\" of radius {} m is not between {:.6g} and "
                      "{:.6g} m, the edges with their rows of elements",
                      ring.name, ring.radius, o.inner_radius + row, o.outer_radius - row));
    }
  }
}

}  // namespace

Mesh annulus(const AnnulusOptions& options)
{
  check_radii(options);
  Mesh mesh = options.pattern == Pattern::structured ? structured_annulus(options)
                                                     : made_by_mesher({.annulus = options});
  add_rings(mesh, options.rings);
  return mesh;
}

namespace {

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

void check_hat_disc(const HatDiscOptions& o)
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
  check_hat_disc(options);
  Mesh mesh = options.pattern == Pattern::structured ? structured_hat_disc(options)
                                                     : made_by_mesher({.hat_disc = options});
  std::vector<RingOptions> rings = options.rings;
  for (RingOptions& ring : rings) ring.z = 0.0;
  add_rings(mesh, rings);
  return mesh;
}

namespace {

double length_of_beam(const BeamMeshOptions& options)
{
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) sum += std::pow(options.end[c] - options.start[c], 2);
  return std::sqrt(sum);
}

/// Ends and points in order, each once.
std::vector<double> stations(const BeamMeshOptions& options, double length)
{
  std::vector<double> distances{0.0, length};
  for (const BeamPoint& point : options.points) distances.push_back(point.distance);
  std::ranges::sort(distances);
  const auto same = [&](double a, double b) { return b - a < 1e-9 * length; };
  distances.erase(std::unique(distances.begin(), distances.end(), same), distances.end());
  return distances;
}

/// Distances of the nodes from the start, m.
std::vector<double> node_distances(const BeamMeshOptions& options, double length)
{
  std::vector<double> nodes{0.0};
  const auto divide = [&](double to, int n_elements) {
    const double from = nodes.back();
    const int n = options.element_order * n_elements;
    for (int i = 1; i <= n; ++i) nodes.push_back(from + (to - from) * i / n);
  };
  if (options.elements) {
    divide(length, *options.elements);
    return nodes;
  }
  for (const double station : stations(options, length)) {
    const double piece = station - nodes.back();
    divide(station, static_cast<int>(std::ceil(piece / options.element_size.value() - 1e-9)));
  }
  return nodes;
}

/// The node at a point; an equal division is met up to the digits of the distance.
int node_at(const BeamPoint& point, const std::vector<double>& nodes)
{
  const auto nearest = std::ranges::min_element(
      nodes, {}, [&](double distance) { return std::abs(distance - point.distance); });
  const double element = nodes.back() / static_cast<double>(nodes.size() - 1);
  if (std::abs(*nearest - point.distance) > 1e-6 * element) {
    throw Error(
        fmt::format("beam: point \"{}\" at {:.9g} m meets no node, the nearest is at {:.9g} "
                    "m; change `elements`, or give `element_size` instead",
                    point.name, point.distance, *nearest));
  }
  return static_cast<int>(nearest - nodes.begin());
}

void add_beam_nodes(Mesh& mesh, const BeamMeshOptions& options, const std::vector<double>& nodes)
{
  for (const double distance : nodes) {
    const double t = distance / nodes.back();
    std::array<double, 3> x{};
    for (std::size_t c = 0; c < 3; ++c) x[c] = (1.0 - t) * options.start[c] + t * options.end[c];
    mesh.positions.push_back(x);
    mesh.node_numbers.push_back(std::ssize(mesh.positions));
  }
}

void add_beam_elements(Mesh& mesh, int order)
{
  ElementBlock block{.shape = Shape::line,
                     .order = order,
                     .nodes_per_element = order + 1,
                     .numbers = {},
                     .nodes = {},
                     .group = {}};
  for (int first = 0; first + 1 < mesh.n_nodes(); first += order) {
    block.numbers.push_back(std::ssize(block.numbers) + 1);
    block.group.push_back(0);
    for (int i = 0; i <= order; ++i) block.nodes.push_back(first + i);
  }
  mesh.blocks.push_back(std::move(block));
}

}  // namespace

Mesh beam(const BeamMeshOptions& options)
{
  const double length = length_of_beam(options);
  if (!(length > 0.0)) throw Error("beam: start and end are the same point");
  const std::vector<double> nodes = node_distances(options, length);
  Mesh mesh;
  add_beam_nodes(mesh, options, nodes);
  add_beam_elements(mesh, options.element_order);
  Group line{.name = "beam", .dimension = 1, .nodes = std::vector<int>(nodes.size())};
  std::iota(line.nodes.begin(), line.nodes.end(), 0);
  mesh.groups = {line,
                 {.name = "start", .dimension = 0, .nodes = {0}},
                 {.name = "end", .dimension = 0, .nodes = {mesh.n_nodes() - 1}}};
  for (const BeamPoint& point : options.points)
    mesh.groups.push_back({.name = point.name, .dimension = 0, .nodes = {node_at(point, nodes)}});
  return mesh;
}

namespace {

std::vector<double> places(double start, double end, const PatchOptions& o)
{
  const std::vector<double> ends{start, end};
  return cut(o.edge_row ? with_edge_rows(ends, *o.edge_row) : ends, o.element_size);
}

/// The places along the path are not equal parts of it where there are edge rows.
Path path_of(const FourEdges& patch, const PatchOptions& o)
{
  const std::vector<double> ends = places(0.0, patch.length, o);
  const auto n = static_cast<int>(ends.size()) - 1;
  const auto position = [=](const Station& s, double t) {
    const int e = std::min(static_cast<int>(std::floor(t * n + 1e-9)), n - 1);
    const double along = ends[e] + (t * n - e) * (ends[e + 1] - ends[e]);
    return patch.position(s, along / patch.length);
  };
  return {.n_elements = n, .closed = false, .order = o.element_order, .position = position};
}

void add_corners(Mesh& mesh, const FourEdges& patch)
{
  Group corners{.name = "corners", .dimension = 0, .nodes = {}};
  for (const std::size_t i : {0U, 1U}) {
    for (const std::size_t j : {2U, 3U}) {
      const std::vector<int> a = find_group(mesh, patch.edges[i]).nodes;
      const std::vector<int> b = find_group(mesh, patch.edges[j]).nodes;
      std::ranges::set_intersection(a, b, std::back_inserter(corners.nodes));
    }
  }
  std::ranges::sort(corners.nodes);
  mesh.groups.push_back(std::move(corners));
}

Mesh structured_patch(const FourEdges& patch, const PatchOptions& o)
{
  Profile profile{.group = patch.surface, .stations = {}};
  for (const double x : places(patch.start, patch.end, o)) profile.stations.push_back({x, 0.0});
  Swept swept = sweep(std::span(&profile, 1), path_of(patch, o));
  add_row_group(swept, profile.stations.front(), patch.edges[0]);
  add_row_group(swept, profile.stations.back(), patch.edges[1]);
  add_column_group(swept, 0, patch.edges[2]);
  add_column_group(swept, swept.n_columns - 1, patch.edges[3]);
  return swept.mesh;
}

/// @param made  the options of the whole, from which Gmsh makes it
Mesh mesh_patch(const FourEdges& patch, const PatchOptions& o, const MeshOptions& made)
{
  const double width = std::min(patch.end - patch.start, patch.length);
  if (!(o.element_size > 0.0 && o.element_size <= width)) {
    throw Error(fmt::format("{}: element_size = {} m must be > 0 and at most the width, {:.6g} m",
                            patch.surface, o.element_size, width));
  }
  if (o.edge_row) {
    check_edge_rows(*o.edge_row, patch.end - patch.start);
    check_edge_rows(*o.edge_row, patch.length);
  }
  Mesh mesh = o.pattern == Pattern::structured ? structured_patch(patch, o) : made_by_mesher(made);
  add_corners(mesh, patch);
  return mesh;
}

}  // namespace

FourEdges edges_of(const RectangleOptions& o)
{
  const double width = o.width;
  return {.surface = "plate",
          .edges = {"left", "right", "bottom", "top"},
          .start = 0.0,
          .end = o.length,
          .length = width,
          .position = [=](const Station& s, double t) {
            return std::array{s[0], t * width, 0.0};
          }};
}

FourEdges edges_of(const PadOptions& o)
{
  const double angle = o.angle;
  const double first = o.centre_angle - 0.5 * angle;
  return {.surface = "pad",
          .edges = {"inner_edge", "outer_edge", "first_edge", "last_edge"},
          .start = o.inner_radius,
          .end = o.outer_radius,
          .length = 0.5 * (o.inner_radius + o.outer_radius) * angle,
          .position =
              [=](const Station& s, double t) {
                const double at = first + t * angle;
                return std::array{s[0] * std::cos(at), s[0] * std::sin(at), 0.0};
              },
          .round = true};
}

Mesh rectangle(const RectangleOptions& o)
{
  if (!(o.length > 0.0 && o.width > 0.0)) {
    throw Error(
        fmt::format("rectangle: length and width must be > 0, not {} and {} m", o.length, o.width));
  }
  return mesh_patch(edges_of(o), patch_of(o), {.rectangle = o});
}

Mesh pad(const PadOptions& o)
{
  if (!(o.inner_radius > 0.0 && o.inner_radius < o.outer_radius)) {
    throw Error(fmt::format("pad: 0 < inner_radius < outer_radius must hold, not {} and {} m",
                            o.inner_radius, o.outer_radius));
  }
  if (!(o.angle > 0.0 && o.angle < std::numbers::pi)) {
    throw Error(fmt::format("pad: its angle must be between 0 and 180 degrees, not {:.6g}",
                            o.angle * 180.0 / std::numbers::pi));
  }
  return mesh_patch(edges_of(o), patch_of(o), {.pad = o});
}

}  // namespace chladni::mesh
