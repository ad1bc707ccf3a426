#include "mesh/gmsh/gmsh.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/curved_rows.hpp"

namespace chladni::mesh {

namespace {

std::vector<Circle> add_circles(const AnnulusOptions& o)
{
  const double h = o.element_size;
  std::vector<Circle> circles{add_circle({.radius = o.inner_radius}, h)};
  for (const RingOptions& ring : o.rings)
    circles.push_back(add_circle({.radius = ring.radius, .n_arcs = ring.nodes}, h));
  circles.push_back(add_circle({.radius = o.outer_radius}, h));
  if (o.edge_row) {
    const Circle inner = circles.front();
    const Circle outer = circles.back();
    circles.push_back(add_circle({.radius = o.inner_radius + *o.edge_row}, inner));
    circles.push_back(add_circle({.radius = o.outer_radius - *o.edge_row}, outer));
  }
  std::ranges::sort(circles, {}, &Circle::radius);
  return circles;
}

std::array<CurvedRow, 2> edge_rows(const AnnulusOptions& o)
{
  return {CurvedRow{.centre = {}, .inner = o.inner_radius, .outer = o.inner_radius + *o.edge_row},
          CurvedRow{.centre = {}, .inner = o.outer_radius - *o.edge_row, .outer = o.outer_radius}};
}

}  // namespace

Mesh unstructured_annulus(const AnnulusOptions& options)
{
  const auto build = [&] {
    gmsh::model::add("annulus");
    set_element_size(options.element_size, options.pattern);
    const std::vector<Circle> circles = add_circles(options);
    const std::vector<int> surfaces =
        add_rings_of_elements(circles, options.element_size, options.edge_row.value_or(0.0));
    gmsh::model::geo::synchronize();
    add_physical_group(1, circles.front().arcs, "inner_edge");
    add_physical_group(1, circles.back().arcs, "outer_edge");
    add_physical_group(2, surfaces, "disc");
  };
  Mesh mesh = mesh_with_gmsh(build, options.element_order);
  if (options.edge_row) bend_triangles(mesh, edge_rows(options));
  return mesh;
}

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

namespace {

namespace geo = gmsh::model::geo;

Circle add_arcs(const CirclePlace& place, int n_elements)
{
  const auto [x, y, z] = place.centre;
  const int centre = geo::addPoint(x, y, z);
  Circle circle{.radius = place.radius, .n_elements = n_elements, .points = {}, .arcs = {}};
  for (int i = 0; i < place.n_arcs; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / place.n_arcs;
    circle.points.push_back(
        geo::addPoint(x + place.radius * std::cos(angle), y + place.radius * std::sin(angle), z));
  }
  for (int i = 0; i < place.n_arcs; ++i) {
    const int arc =
        geo::addCircleArc(circle.points[i], centre, circle.points[(i + 1) % place.n_arcs]);
    geo::mesh::setTransfiniteCurve(arc, n_elements + 1);
    circle.arcs.push_back(arc);
  }
  return circle;
}

int add_line(int from, int to, int n_elements)
{
  const int line = geo::addLine(from, to);
  geo::mesh::setTransfiniteCurve(line, n_elements + 1);
  return line;
}

double distance_of_points(int first_point, int last_point)
{
  std::vector<double> a, b;
  geo::synchronize();
  gmsh::model::getValue(0, first_point, {}, a);
  gmsh::model::getValue(0, last_point, {}, b);
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

Circle add_circle(const CirclePlace& place, double size)
{
  const double arc_length = 2.0 * std::numbers::pi * place.radius / place.n_arcs;
  const int n_least = (12 + place.n_arcs - 1) / place.n_arcs;
  return add_arcs(place, std::max(n_least, static_cast<int>(std::lround(arc_length / size))));
}

Circle add_circle(const CirclePlace& place, const Circle& like)
{
  return add_arcs({.radius = place.radius,
                   .centre = place.centre,
                   .n_arcs = static_cast<int>(like.arcs.size())},
                  like.n_elements);
}

std::vector<int> add_rows(const Circle& first, const Circle& last, double size)
{
  const double width = distance_of_points(first.points[0], last.points[0]);
  const int n_across = std::max(1, static_cast<int>(std::lround(width / size)));
  const std::size_t n = first.arcs.size();
  std::vector<int> spokes;
  for (std::size_t i = 0; i < n; ++i)
    spokes.push_back(add_line(first.points[i], last.points[i], n_across));
  std::vector<int> surfaces;
  for (std::size_t i = 0; i < n; ++i) {
    const int loop =
        geo::addCurveLoop({spokes[i], last.arcs[i], -spokes[(i + 1) % n], -first.arcs[i]});
    const int surface = geo::addSurfaceFilling({loop});
    geo::mesh::setTransfiniteSurface(surface);
    surfaces.push_back(surface);
  }
  return surfaces;
}

int add_plane(const Circle& outer, const std::vector<Circle>& holes)
{
  std::vector<int> loops{geo::addCurveLoop(outer.arcs)};
  for (const Circle& hole : holes) loops.push_back(geo::addCurveLoop(hole.arcs));
  return geo::addPlaneSurface(loops);
}

std::vector<int> add_rings_of_elements(const std::vector<Circle>& circles, double size, double row)
{
  std::vector<int> surfaces;
  for (std::size_t i = 0; i + 1 < circles.size(); ++i) {
    const Circle& inner = circles[i];
    const Circle& outer = circles[i + 1];
    const bool is_row = std::abs(outer.radius - inner.radius - row) < 1e-9 * outer.radius;
    if (is_row && inner.arcs.size() == outer.arcs.size() && inner.n_elements == outer.n_elements) {
      const std::vector<int> rows = add_rows(inner, outer, size);
      surfaces.insert(surfaces.end(), rows.begin(), rows.end());
    } else {
      surfaces.push_back(add_plane(outer, {inner}));
    }
  }
  return surfaces;
}

void set_element_size(double size, Pattern pattern)
{
  gmsh::option::setNumber("Mesh.MeshSizeMin", size);
  gmsh::option::setNumber("Mesh.MeshSizeMax", size);
  // The size holds inside too, not the length of a ring's arcs.
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
  if (pattern == Pattern::triangles) gmsh::option::setNumber("Mesh.RecombineAll", 0);
}

void add_physical_group(int dimension, const std::vector<int>& entities, const std::string& name)
{
  const int tag = gmsh::model::addPhysicalGroup(dimension, entities);
  gmsh::model::setPhysicalName(dimension, tag, name);
}

}  // namespace chladni::mesh
