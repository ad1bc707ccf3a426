#include <gmsh.h>

#include <algorithm>

#include "mesh/curved_rows.hpp"
#include "mesh/gmsh/circles.hpp"
#include "mesh/gmsh/generators.hpp"
#include "mesh/gmsh/model.hpp"

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

}  // namespace chladni::mesh
