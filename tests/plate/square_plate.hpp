#pragma once

#include <map>
#include <string>

#include "mesh/mesh.hpp"

namespace chladni::plate::testing {

/// A rectangle [0, a] x [0, b] of n_x by n_y quadrilaterals of order p. Groups: "plate", its edges
/// "left" (x = 0), "right", "bottom" (y = 0), "top", the line "middle" (x = a / 2, if it has nodes)
/// and the nodes "centre" (likewise) and "corner" (a, b).
struct Rectangle {
  double a, b;
  int n_x, n_y, order;
};

inline mesh::Mesh rectangle(const Rectangle& r)
{
  const int p = r.order;
  const int n_i = p * r.n_x + 1, n_j = p * r.n_y + 1;
  mesh::Mesh mesh;
  std::map<std::string, std::vector<int>> groups;
  for (int j = 0, node = 0; j < n_j; ++j) {
    for (int i = 0; i < n_i; ++i, ++node) {
      mesh.positions.push_back({r.a * i / (n_i - 1), r.b * j / (n_j - 1), 0.0});
      mesh.node_numbers.push_back(node + 1);
      groups["plate"].push_back(node);
      if (i == 0) groups["left"].push_back(node);
      if (i == n_i - 1) groups["right"].push_back(node);
      if (2 * i == n_i - 1) groups["middle"].push_back(node);
      if (j == 0) groups["bottom"].push_back(node);
      if (j == n_j - 1) groups["top"].push_back(node);
      if (2 * i == n_i - 1 && 2 * j == n_j - 1) groups["centre"].push_back(node);
      if (i == n_i - 1 && j == n_j - 1) groups["corner"].push_back(node);
    }
  }
  for (auto& [name, nodes] : groups)
    mesh.groups.push_back({.name = name, .dimension = name == "plate" ? 2 : 1, .nodes = nodes});
  const auto plate = static_cast<int>(&mesh::find_group(mesh, "plate") - mesh.groups.data());
  mesh::ElementBlock block{.shape = mesh::Shape::quadrilateral,
                           .order = p,
                           .nodes_per_element = (p + 1) * (p + 1),
                           .numbers = {},
                           .nodes = {},
                           .group = {}};
  for (int e = 0; e < r.n_x * r.n_y; ++e) {
    block.numbers.push_back(e + 1);
    block.group.push_back(plate);
    for (int j = 0; j <= p; ++j)
      for (int i = 0; i <= p; ++i)
        block.nodes.push_back((p * (e / r.n_x) + j) * n_i + p * (e % r.n_x) + i);
  }
  mesh.blocks.push_back(block);
  return mesh;
}

}  // namespace chladni::plate::testing
