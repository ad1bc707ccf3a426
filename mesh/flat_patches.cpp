#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "mesh/circles.hpp"
#include "mesh/curved_rows.hpp"
#include "mesh/generators.hpp"
#include "mesh/gmsh_model.hpp"
#include "mesh/sweep.hpp"

namespace chladni::mesh {

namespace {

/// A plane surface with four edges: two at the ends of the profile, two at the ends of the path.
struct FourEdges {
  std::string surface;
  std::array<std::string, 4> edges;  ///< start and end of the profile, start and end of the path
  double start, end;                 ///< of the profile, m
  double length;                     ///< of the path, m
  std::function<std::array<double, 3>(const Station&, double t)> position;
  bool round = false;  ///< edges at the ends of the profile are arcs about the origin
};

struct PatchOptions {
  double element_size;
  int element_order;
  Pattern pattern;
  std::optional<double> edge_row;
};

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

/// Corners in the order of the boundary, then the edges between them.
std::array<int, 4> add_boundary(const FourEdges& patch)
{
  namespace geo = gmsh::model::geo;
  const std::array<std::array<double, 2>, 4> corners{
      {{patch.start, 0.0}, {patch.end, 0.0}, {patch.end, 1.0}, {patch.start, 1.0}}};
  std::array<int, 4> points{};
  std::array<int, 4> curves{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto x = patch.position({corners[i][0], 0.0}, corners[i][1]);
    points[i] = geo::addPoint(x[0], x[1], x[2]);
  }
  const int centre = patch.round ? geo::addPoint(0.0, 0.0, 0.0) : 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const int a = points[i];
    const int b = points[(i + 1) % 4];
    const bool arc = patch.round && i % 2 == 1;
    curves[i] = arc ? geo::addCircleArc(a, centre, b) : geo::addLine(a, b);
  }
  return curves;
}

/// Curves of a patch in Gmsh: its surfaces, and its edges in the order of FourEdges.
struct PatchModel {
  std::vector<int> surfaces;
  std::array<std::vector<int>, 4> edges;
};

PatchModel add_patch(const FourEdges& patch)
{
  const auto [first, end, last, start] = add_boundary(patch);
  namespace geo = gmsh::model::geo;
  return {.surfaces = {geo::addPlaneSurface({geo::addCurveLoop({first, end, last, start})})},
          .edges = {{{start}, {end}, {first}, {last}}}};
}

/// The patch cut into three by three along its edge rows: the middle is left to Gmsh, around it
/// stand rows of elements.
class PatchInRows {
 public:
  PatchInRows(const FourEdges& patch, const PatchOptions& o)
      : patch_(patch),
        size_(o.element_size),
        along_profile_{patch.start, patch.start + *o.edge_row, patch.end - *o.edge_row, patch.end},
        along_path_{0.0, *o.edge_row / patch.length, 1.0 - *o.edge_row / patch.length, 1.0}
  {
    check_edge_rows(*o.edge_row, patch.end - patch.start);
    check_edge_rows(*o.edge_row, patch.length);
  }

  PatchModel add()
  {
    add_points();
    PatchModel model;
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        across_[i][k] = add_curve(points_[i][k], points_[i + 1][k], Direction::profile, i);
        along_[k][i] = add_curve(points_[k][i], points_[k][i + 1], Direction::path, i);
      }
    }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) model.surfaces.push_back(add_surface(i, j));
    const auto all = [](const std::array<int, 3>& of) {
      return std::vector<int>(of.begin(), of.end());
    };
    const auto ends = [&](std::size_t k) {
      return std::vector<int>{across_[0][k], across_[1][k], across_[2][k]};
    };
    model.edges = {all(along_[0]), all(along_[3]), ends(0), ends(3)};
    return model;
  }

 private:
  enum class Direction { profile, path };

  void add_points()
  {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        const auto x = patch_.position({along_profile_[i], 0.0}, along_path_[j]);
        points_[i][j] = gmsh::model::geo::addPoint(x[0], x[1], x[2]);
      }
    }
    centre_ = patch_.round ? gmsh::model::geo::addPoint(0.0, 0.0, 0.0) : 0;
  }
  int add_curve(int from, int to, Direction direction, std::size_t interval)
  {
    namespace geo = gmsh::model::geo;
    const bool arc = patch_.round && direction == Direction::path;
    const int curve = arc ? geo::addCircleArc(from, centre_, to) : geo::addLine(from, to);
    const double length = direction == Direction::path
                              ? patch_.length * (along_path_[2] - along_path_[1])
                              : along_profile_[2] - along_profile_[1];
    const auto n = interval == 1 ? std::max(1, static_cast<int>(std::lround(length / size_))) : 1;
    geo::mesh::setTransfiniteCurve(curve, n + 1);
    return curve;
  }
  int add_surface(std::size_t i, std::size_t j)
  {
    namespace geo = gmsh::model::geo;
    const int surface = geo::addPlaneSurface(
        {geo::addCurveLoop({across_[i][j], along_[i + 1][j], -across_[i][j + 1], -along_[i][j]})});
    if (i != 1 || j != 1) geo::mesh::setTransfiniteSurface(surface);
    return surface;
  }

  const FourEdges& patch_;
  double size_;
  std::array<double, 4> along_profile_, along_path_;
  std::array<std::array<int, 4>, 4> points_{};
  int centre_ = 0;
  std::array<std::array<int, 4>, 3> across_{};  ///< [interval][place on the path]
  std::array<std::array<int, 3>, 4> along_{};   ///< [place on the profile][interval]
};

Mesh patch_by_gmsh(const FourEdges& patch, const PatchOptions& o)
{
  const auto build = [&] {
    gmsh::model::add(patch.surface);
    set_element_size(o.element_size, o.pattern);
    const PatchModel model = o.edge_row ? PatchInRows(patch, o).add() : add_patch(patch);
    gmsh::model::geo::synchronize();
    for (std::size_t i = 0; i < 4; ++i) add_physical_group(1, model.edges[i], patch.edges[i]);
    add_physical_group(2, model.surfaces, patch.surface);
  };
  Mesh mesh = mesh_with_gmsh(build, o.element_order);
  if (o.edge_row && patch.round) {
    const double row = *o.edge_row;
    bend_triangles(
        mesh, std::array{CurvedRow{.centre = {}, .inner = patch.start, .outer = patch.start + row},
                         CurvedRow{.centre = {}, .inner = patch.end - row, .outer = patch.end}});
  }
  return mesh;
}

Mesh mesh_patch(const FourEdges& patch, const PatchOptions& o)
{
  const double width = std::min(patch.end - patch.start, patch.length);
  if (!(o.element_size > 0.0 && o.element_size <= width)) {
    throw Error(fmt::format("{}: element_size = {} m must be > 0 and at most the width, {:.6g} m",
                            patch.surface, o.element_size, width));
  }
  Mesh mesh =
      o.pattern == Pattern::structured ? structured_patch(patch, o) : patch_by_gmsh(patch, o);
  add_corners(mesh, patch);
  return mesh;
}

}  // namespace

Mesh rectangle(const RectangleOptions& o)
{
  if (!(o.length > 0.0 && o.width > 0.0)) {
    throw Error(
        fmt::format("rectangle: length and width must be > 0, not {} and {} m", o.length, o.width));
  }
  const double width = o.width;
  return mesh_patch({.surface = "plate",
                     .edges = {"left", "right", "bottom", "top"},
                     .start = 0.0,
                     .end = o.length,
                     .length = width,
                     .position =
                         [=](const Station& s, double t) {
                           return std::array{s[0], t * width, 0.0};
                         }},
                    {o.element_size, o.element_order, o.pattern, o.edge_row});
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
  const double angle = o.angle;
  const double first = o.centre_angle - 0.5 * angle;
  return mesh_patch({.surface = "pad",
                     .edges = {"inner_edge", "outer_edge", "first_edge", "last_edge"},
                     .start = o.inner_radius,
                     .end = o.outer_radius,
                     .length = 0.5 * (o.inner_radius + o.outer_radius) * angle,
                     .position =
                         [=](const Station& s, double t) {
                           const double at = first + t * angle;
                           return std::array{s[0] * std::cos(at), s[0] * std::sin(at), 0.0};
                         },
                     .round = true},
                    {o.element_size, o.element_order, o.pattern, o.edge_row});
}

}  // namespace chladni::mesh
