#include "polar_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace chladni::benchmarks {

namespace {

/// Ends of the rows of elements, ascending: of one width, but for edge rows.
std::vector<double> row_ends(const PolarGrid& o)
{
  const int n_inside = o.edge_row > 0.0 ? o.n_r - 2 : o.n_r;
  const double start = o.inner_radius + o.edge_row;
  const double width = (o.outer_radius - o.edge_row - start) / n_inside;
  std::vector<double> ends;
  if (o.edge_row > 0.0) ends.push_back(o.inner_radius);
  for (int i = 0; i <= n_inside; ++i) ends.push_back(start + i * width);
  if (o.edge_row > 0.0) ends.push_back(o.outer_radius);
  return ends;
}

}  // namespace

mesh::Mesh polar_grid(const PolarGrid& options)
{
  const auto [inner_radius, outer_radius, order, n_r, edge_row] = options;
  const std::vector<double> ends = row_ends(options);
  const int n_rings = n_r * order + 1;
  const int n_around = 4 * n_r * order;
  mesh::Mesh grid;
  mesh::Group disc{.name = "disc", .dimension = 2, .nodes = {}};
  mesh::Group inner_edge{.name = "inner_edge", .dimension = 1, .nodes = {}};
  for (int j = 0; j < n_rings; ++j) {
    const auto row = static_cast<std::size_t>(std::min(j / order, n_r - 1));
    const double share = double(j) / order - double(row);
    const double r = ends[row] + share * (ends[row + 1] - ends[row]);
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
