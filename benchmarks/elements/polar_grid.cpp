#include "polar_grid.hpp"

#include <cmath>
#include <numbers>

namespace chladni::benchmarks {

mesh::Mesh polar_grid(double inner_radius, double outer_radius, int order, int n_r)
{
  const int n_rings = n_r * order + 1;
  const int n_around = 4 * n_r * order;
  mesh::Mesh grid;
  mesh::Group disc{.name = "disc", .dimension = 2, .nodes = {}};
  mesh::Group inner_edge{.name = "inner_edge", .dimension = 1, .nodes = {}};
  for (int j = 0; j < n_rings; ++j) {
    const double r = inner_radius + (outer_radius - inner_radius) * j / (n_rings - 1);
    for (int i = 0; i < n_around; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / n_around;
      disc.nodes.push_back(grid.n_nodes());
      if (j == 0) inner_edge.nodes.push_back(grid.n_nodes());
      grid.positions.push_back({r * std::cos(angle), r * std::sin(angle), 0.0});
      grid.node_numbers.push_back(grid.n_nodes());
    }
  }
  mesh::ElementBlock block{.shape = mesh::Shape::quadrilateral,
                           .order = order,
                           .nodes_per_element = (order + 1) * (order + 1),
                           .numbers = {},
                           .nodes = {},
                           .group = {}};
  for (int e = 0; e < 4 * n_r * n_r; ++e) {
    const int first = e % (4 * n_r) * order, ring = e / (4 * n_r) * order;
    for (int j = 0; j <= order; ++j) {
      for (int i = 0; i <= order; ++i) {
        // xi runs outwards and eta around, for a right-handed element.
        block.nodes.push_back((ring + i) * n_around + (first + j) % n_around);
      }
    }
    block.numbers.push_back(e + 1);
    block.group.push_back(0);
  }
  grid.groups = {disc, inner_edge};
  grid.blocks = {block};
  return grid;
}

}  // namespace chladni::benchmarks
