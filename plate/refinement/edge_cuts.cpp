#include "plate/refinement/edge_cuts.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/element_parts.hpp"

namespace chladni::plate {

namespace {

std::vector<int> key_of(std::vector<int> edge)
{
  std::ranges::sort(edge);
  return edge;
}

}  // namespace

EdgeCuts::EdgeCuts(const mesh::Mesh& mesh, const std::vector<double>& rows)
    : mesh_(mesh), rows_(rows), is_free_(mesh.positions.size(), 0)
{
  if (rows.empty()) return;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (block.shape == mesh::Shape::line) continue;
    for (int e = 0; e < block.n_elements(); ++e)
      for (const std::vector<int>& edge : mesh::edges_of(block, e)) ++n_elements_[key_of(edge)];
  }
  for (const auto& [edge, n] : n_elements_)
    if (n == 1)
      for (const int node : edge) is_free_[static_cast<std::size_t>(node)] = 1;
}

double EdgeCuts::cut(const std::vector<int>& edge) const
{
  constexpr double middle = 0.5;
  constexpr double near_middle = 0.3;  // a half of the element is about as wide as the row
  if (rows_.empty()) return middle;
  const auto a = static_cast<std::size_t>(edge.front()), b = static_cast<std::size_t>(edge.back());
  if (is_free_[a] == is_free_[b]) return middle;
  const auto& x = mesh_.positions[a];
  const auto& y = mesh_.positions[b];
  const double length = std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
  const double share = rows_[is_free_[a] != 0 ? a : b] / length;
  if (share > near_middle) return middle;
  return is_free_[a] != 0 ? share : 1.0 - share;
}

Cuts EdgeCuts::cuts(const mesh::ElementBlock& block, int element) const
{
  Cuts cuts = in_the_middle;
  if (rows_.empty() || block.shape == mesh::Shape::line) return cuts;
  const std::vector<std::vector<int>> edges = mesh::edges_of(block, element);
  for (std::size_t k = 0; k < edges.size(); ++k) cuts.at(k) = cut(edges[k]);
  return cuts;
}

}  // namespace chladni::plate
