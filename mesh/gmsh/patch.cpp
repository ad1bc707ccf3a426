#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/curved_rows.hpp"
#include "mesh/gmsh/circles.hpp"
#include "mesh/gmsh/generators.hpp"
#include "mesh/gmsh/model.hpp"

namespace chladni::mesh {

namespace {

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
  {}

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

}  // namespace

Mesh unstructured_patch(const FourEdges& patch, const PatchOptions& o)
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

}  // namespace chladni::mesh
