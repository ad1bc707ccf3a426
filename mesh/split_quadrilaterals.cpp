#include "mesh/split_quadrilaterals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/vectors.hpp"

namespace chladni::mesh {

namespace {

const double cosine_limit = std::cos(165.0 * std::numbers::pi / 180.0);

/// Lattice place of column i, row j.
int place(int order, int i, int j)
{
  return j * (order + 1) + i;
}

/// Cosine of the angle between the two edges of a corner, from their next lattice nodes.
double corner_cosine(const Mesh& mesh, const ElementBlock& block, int element, int corner)
{
  const int p = block.order;
  const int i = corner % 2 * p;
  const int j = corner / 2 * p;
  const auto nodes = block.element_nodes(element);
  const Vector& x = mesh.positions[nodes[place(p, i, j)]];
  const int next_i = i == 0 ? 1 : p - 1;
  const int next_j = j == 0 ? 1 : p - 1;
  const Vector a = minus(mesh.positions[nodes[place(p, next_i, j)]], x);
  const Vector b = minus(mesh.positions[nodes[place(p, i, next_j)]], x);
  return dot(a, b) / std::sqrt(dot(a, a) * dot(b, b));
}

/// The flattest corner (0..3: column + 2 row) beyond the limit, or -1.
int flat_corner(const Mesh& mesh, const ElementBlock& block, int element)
{
  int flattest = -1;
  double least = cosine_limit;
  for (int corner = 0; corner < 4; ++corner) {
    const double cosine = corner_cosine(mesh, block, element, corner);
    if (cosine < least) {
      least = cosine;
      flattest = corner;
    }
  }
  return flattest;
}

void add_triangle(ElementBlock& triangles, const ElementBlock& quads, int element,
                  const std::vector<int>& places)
{
  for (const int k : places) triangles.nodes.push_back(quads.element_nodes(element)[k]);
  triangles.numbers.push_back(quads.numbers[element]);
  triangles.group.push_back(quads.group[element]);
}

/// Both halves, with the right angle of each lattice at the corner opposite to the new edge.
void add_halves(ElementBlock& triangles, const ElementBlock& quads, int element, int corner)
{
  const int p = quads.order;
  const bool falling =
      corner == 1 || corner == 2;  // the new edge joins corners 1 and 2, or 0 and 3
  std::vector<int> first;
  std::vector<int> second;
  for (int j = 0; j <= p; ++j) {
    for (int i = 0; i <= p - j; ++i) {
      first.push_back(falling ? place(p, i, j) : place(p, p - j, i));
      second.push_back(falling ? place(p, p - i, p - j) : place(p, j, p - i));
    }
  }
  add_triangle(triangles, quads, element, first);
  add_triangle(triangles, quads, element, second);
}

ElementBlock& triangles_of_order(Mesh& mesh, int order)
{
  const auto it = std::ranges::find_if(mesh.blocks, [&](const ElementBlock& b) {
    return b.shape == Shape::triangle && b.order == order;
  });
  if (it != mesh.blocks.end()) return *it;
  mesh.blocks.push_back(ElementBlock{.shape = Shape::triangle,
                                     .order = order,
                                     .nodes_per_element = (order + 1) * (order + 2) / 2,
                                     .numbers = {},
                                     .nodes = {},
                                     .group = {}});
  return mesh.blocks.back();
}

ElementBlock without_elements(const ElementBlock& block)
{
  ElementBlock kept = block;
  kept.numbers.clear();
  kept.nodes.clear();
  kept.group.clear();
  return kept;
}

void split_block(Mesh& mesh, std::size_t b)
{
  const ElementBlock quads = mesh.blocks[b];
  ElementBlock kept = without_elements(quads);
  for (int e = 0; e < quads.n_elements(); ++e) {
    const int corner = flat_corner(mesh, quads, e);
    if (corner >= 0) {
      add_halves(triangles_of_order(mesh, quads.order), quads, e, corner);
      continue;
    }
    const auto nodes = quads.element_nodes(e);
    kept.nodes.insert(kept.nodes.end(), nodes.begin(), nodes.end());
    kept.numbers.push_back(quads.numbers[e]);
    kept.group.push_back(quads.group[e]);
  }
  mesh.blocks[b] = std::move(kept);
}

}  // namespace

Mesh split_flat_corners(Mesh mesh)
{
  const std::size_t n_blocks = mesh.blocks.size();
  for (std::size_t b = 0; b < n_blocks; ++b)
    if (mesh.blocks[b].shape == Shape::quadrilateral) split_block(mesh, b);
  std::erase_if(mesh.blocks, [](const ElementBlock& block) { return block.numbers.empty(); });
  return mesh;
}

}  // namespace chladni::mesh
