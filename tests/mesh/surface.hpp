#pragma once

#include "mesh/mesh.hpp"

namespace chladni::mesh::testing {

/// Area of the polygon of the corners, signed by the orientation about z; a first look at an
/// element.
inline double corner_area(const Mesh& mesh, const ElementBlock& block, int e)
{
  const int p = block.order;
  const int n = block.nodes_per_element;
  const auto nodes = block.element_nodes(e);
  const std::vector<int> corners = block.shape == Shape::triangle
                                       ? std::vector<int>{0, p, n - 1}
                                       : std::vector<int>{0, p, n - 1, n - 1 - p};
  double twice = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto& a = mesh.positions[nodes[corners[i]]];
    const auto& b = mesh.positions[nodes[corners[(i + 1) % corners.size()]]];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return 0.5 * twice;
}

}  // namespace chladni::mesh::testing
