#include "mesh/complete_elements.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"

namespace chladni::mesh {

namespace {

using Vector = std::array<double, 3>;

void add_scaled(Vector& sum, double factor, const Vector& x)
{
  for (std::size_t c = 0; c < 3; ++c) sum[c] += factor * x[c];
}

/// Coons' patch: opposite edges blended linearly, less the bilinear one of the corners.
Vector inside_quadrilateral(const Mesh& mesh, const ElementBlock& block, int element, int place)
{
  const int p = block.order;
  const int i = place % (p + 1);
  const int j = place / (p + 1);
  const double r = double(i) / p;
  const double s = double(j) / p;
  const auto at = [&](int column, int row) -> const Vector& {
    return mesh.positions[block.element_nodes(element)[row * (p + 1) + column]];
  };
  Vector x{};
  add_scaled(x, 1.0 - s, at(i, 0));
  add_scaled(x, s, at(i, p));
  add_scaled(x, 1.0 - r, at(0, j));
  add_scaled(x, r, at(p, j));
  add_scaled(x, -(1.0 - r) * (1.0 - s), at(0, 0));
  add_scaled(x, -r * (1.0 - s), at(p, 0));
  add_scaled(x, -(1.0 - r) * s, at(0, p));
  add_scaled(x, -r * s, at(p, p));
  return x;
}

/// The centre of a cubic triangle such that the element holds all quadratic shapes.
Vector inside_cubic_triangle(const Mesh& mesh, const ElementBlock& block, int element)
{
  const auto nodes = block.element_nodes(element);
  Vector x{};
  for (const int corner : {0, 3, 9}) add_scaled(x, -1.0 / 6.0, mesh.positions[nodes[corner]]);
  for (const int inner : {1, 2, 4, 6, 7, 8}) add_scaled(x, 0.25, mesh.positions[nodes[inner]]);
  return x;
}

Vector inner_position(const Mesh& mesh, const ElementBlock& block, int element, int place)
{
  if (block.shape == Shape::quadrilateral) return inside_quadrilateral(mesh, block, element, place);
  if (block.order == 3) return inside_cubic_triangle(mesh, block, element);
  throw Error(
      fmt::format("element {} is a triangle of order {} without inner nodes; set "
                  "Mesh.SecondOrderIncomplete = 0 in Gmsh",
                  block.numbers[element], block.order));
}

}  // namespace

void add_inner_nodes(Mesh& mesh)
{
  const int n_before = mesh.n_nodes();
  std::int64_t number = 0;
  for (const std::int64_t n : mesh.node_numbers) number = std::max(number, n);
  for (ElementBlock& block : mesh.blocks) {
    for (std::size_t k = 0; k < block.nodes.size(); ++k) {
      if (block.nodes[k] >= 0) continue;
      const auto element = static_cast<int>(k / block.nodes_per_element);
      const auto place = static_cast<int>(k % block.nodes_per_element);
      const Vector x = inner_position(mesh, block, element, place);
      block.nodes[k] = mesh.n_nodes();
      if (block.group[element] >= 0)
        mesh.groups[block.group[element]].nodes.push_back(mesh.n_nodes());
      mesh.node_numbers.push_back(++number);
      mesh.positions.push_back(x);
    }
  }
  if (mesh.n_nodes() == n_before) return;
  mesh.notes.push_back(
      fmt::format("serendipity elements were completed by {} inner nodes, numbered from {}",
                  mesh.n_nodes() - n_before, number - (mesh.n_nodes() - n_before) + 1));
}

}  // namespace chladni::mesh
