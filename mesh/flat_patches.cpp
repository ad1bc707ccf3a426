#include "mesh/flat_patches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "mesh/generators.hpp"
#include "mesh/mesher.hpp"
#include "mesh/sweep.hpp"

namespace chladni::mesh {

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
