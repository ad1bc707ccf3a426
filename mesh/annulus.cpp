#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "mesh/generate.hpp"
#include "mesh/gmsh_model.hpp"
#include "mesh/rings.hpp"

namespace chladni::mesh {

namespace {

/// A circle about the origin, split into equal arcs that begin on the x axis.
struct Circle {
  double radius;
  int n_arcs;
  std::vector<int> arcs;  ///< tags of Gmsh curves
};

Circle add_circle(double radius, int n_arcs, double element_size)
{
  namespace geo = gmsh::model::geo;
  const int centre = geo::addPoint(0.0, 0.0, 0.0);
  std::vector<int> points;
  for (int i = 0; i < n_arcs; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n_arcs;
    points.push_back(geo::addPoint(radius * std::cos(angle), radius * std::sin(angle), 0.0));
  }
  Circle circle{.radius = radius, .n_arcs = n_arcs, .arcs = {}};
  const double arc_length = 2.0 * std::numbers::pi * radius / n_arcs;
  // At least 12 elements on a circle: a cubic edge of 90 degrees folds the element over.
  const int n_least = (12 + n_arcs - 1) / n_arcs;
  const int n_elements =
      std::max(n_least, static_cast<int>(std::lround(arc_length / element_size)));
  for (int i = 0; i < n_arcs; ++i) {
    const int arc = geo::addCircleArc(points[i], centre, points[(i + 1) % n_arcs]);
    geo::mesh::setTransfiniteCurve(arc, n_elements + 1);
    circle.arcs.push_back(arc);
  }
  return circle;
}

std::vector<Circle> add_circles(const AnnulusOptions& options)
{
  constexpr int n_arcs_of_edge = 4;
  const double h = options.element_size;
  std::vector<Circle> circles{add_circle(options.inner_radius, n_arcs_of_edge, h)};
  for (const RingOptions& ring : options.rings) {
    circles.push_back(add_circle(ring.radius, ring.nodes, h));
  }
  circles.push_back(add_circle(options.outer_radius, n_arcs_of_edge, h));
  std::ranges::sort(circles, {}, &Circle::radius);
  return circles;
}

/// Annular surfaces between neighbouring circles.
std::vector<int> add_surfaces(const std::vector<Circle>& circles)
{
  namespace geo = gmsh::model::geo;
  std::vector<int> loops;
  loops.reserve(circles.size());
  for (const Circle& circle : circles) loops.push_back(geo::addCurveLoop(circle.arcs));
  std::vector<int> surfaces;
  for (std::size_t i = 0; i + 1 < circles.size(); ++i) {
    surfaces.push_back(geo::addPlaneSurface({loops[i + 1], loops[i]}));
  }
  return surfaces;
}

void add_physical_group(int dimension, const std::vector<int>& entities, const std::string& name)
{
  const int tag = gmsh::model::addPhysicalGroup(dimension, entities);
  gmsh::model::setPhysicalName(dimension, tag, name);
}

void check_radii(const AnnulusOptions& o)
{
  if (!(o.inner_radius > 0.0 && o.inner_radius < o.outer_radius)) {
    throw Error(fmt::format("annulus: 0 < inner_radius < outer_radius must hold, not {} and {} m",
                            o.inner_radius, o.outer_radius));
  }
  for (const RingOptions& ring : o.rings) {
    if (!(ring.radius > o.inner_radius && ring.radius < o.outer_radius)) {
      throw Error(fmt::format("annulus: ring \"{}\" of radius {} m is not between {} and {} m",
                              ring.name, ring.radius, o.inner_radius, o.outer_radius));
    }
  }
}

}  // namespace

Mesh annulus(const AnnulusOptions& options)
{
  check_radii(options);
  const auto build = [&] {
    gmsh::model::add("annulus");
    const double h = options.element_size;
    gmsh::option::setNumber("Mesh.MeshSizeMin", h);
    gmsh::option::setNumber("Mesh.MeshSizeMax", h);
    // The size holds inside too, not the length of the ring's arcs.
    gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
    const std::vector<Circle> circles = add_circles(options);
    const std::vector<int> surfaces = add_surfaces(circles);
    gmsh::model::geo::synchronize();
    add_physical_group(1, circles.front().arcs, "inner_edge");
    add_physical_group(1, circles.back().arcs, "outer_edge");
    add_physical_group(2, surfaces, "disc");
  };
  Mesh mesh = mesh_with_gmsh(build, options.element_order);
  add_rings(mesh, options.rings);
  return mesh;
}

}  // namespace chladni::mesh
