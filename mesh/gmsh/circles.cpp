#include "mesh/gmsh/circles.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chladni::mesh {

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

double distance(int first_point, int last_point)
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
  const double width = distance(first.points[0], last.points[0]);
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
