#pragma once

#include <cmath>

#include "mesh/mesh.hpp"

namespace chladni::mesh::testing {

/// Corner nodes of an element, around it.
inline std::vector<int> corners(const ElementBlock& block, int e)
{
  const int p = block.order;
  const int n = block.nodes_per_element;
  const auto nodes = block.element_nodes(e);
  if (block.shape == Shape::triangle) return {nodes[0], nodes[p], nodes[n - 1]};
  return {nodes[0], nodes[p], nodes[n - 1], nodes[n - 1 - p]};
}

/// Area of the polygon of the corners in space.
inline double corner_area_3d(const Mesh& mesh, const ElementBlock& block, int e)
{
  const std::vector<int> around = corners(block, e);
  std::array<double, 3> twice{};
  for (std::size_t i = 0; i < around.size(); ++i) {
    const auto& a = mesh.positions[around[i]];
    const auto& b = mesh.positions[around[(i + 1) % around.size()]];
    for (std::size_t c = 0; c < 3; ++c)
      twice[c] += a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
  }
  return 0.5 * std::hypot(twice[0], twice[1], twice[2]);
}

/// Area of the polygon of the corners, signed by the orientation about z; a first look at an
/// element.
inline double corner_area(const Mesh& mesh, const ElementBlock& block, int e)
{
  const std::vector<int> around = corners(block, e);
  double twice = 0.0;
  for (std::size_t i = 0; i < around.size(); ++i) {
    const auto& a = mesh.positions[around[i]];
    const auto& b = mesh.positions[around[(i + 1) % around.size()]];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return 0.5 * twice;
}

}  // namespace chladni::mesh::testing
