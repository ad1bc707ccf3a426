#include "mesh/element_parts.hpp"

#include <algorithm>
#include <set>
#include <span>
#include <utility>

namespace chladni::mesh {
namespace {

/// Lattice place of column i and row j; the rows of a triangle grow shorter.
class Lattice {
 public:
  explicit Lattice(const ElementBlock& block)
      : p_(block.order), is_triangle_(block.shape == Shape::triangle)
  {}
  int operator()(int i, int j) const
  {
    return is_triangle_ ? j * (p_ + 1) - j * (j - 1) / 2 + i : j * (p_ + 1) + i;
  }

 private:
  int p_;
  bool is_triangle_;
};

std::vector<LatticeCell> line_cells(int p, int step)
{
  std::vector<LatticeCell> cells;
  for (int i = 0; i < p; i += step) cells.push_back({i, i + step, i + step, i + step});
  return cells;
}

std::vector<int> quadrilateral_order(int p)
{
  const auto place = [&](int i, int j) { return j * (p + 1) + i; };
  std::vector<int> order{place(0, 0), place(p, 0), place(p, p), place(0, p)};
  for (int i = 1; i < p; ++i) order.push_back(place(i, 0));
  for (int j = 1; j < p; ++j) order.push_back(place(p, j));
  for (int i = 1; i < p; ++i) order.push_back(place(i, p));
  for (int j = 1; j < p; ++j) order.push_back(place(0, j));
  for (int j = 1; j < p; ++j)
    for (int i = 1; i < p; ++i) order.push_back(place(i, j));
  return order;
}

/// The inner nodes, up to order 4, are a triangle of order p - 3.
std::vector<int> triangle_order(int p)
{
  const auto place = [&](int i, int j) { return j * (p + 1) - j * (j - 1) / 2 + i; };
  std::vector<int> order{place(0, 0), place(p, 0), place(0, p)};
  for (int i = 1; i < p; ++i) order.push_back(place(i, 0));
  for (int i = 1; i < p; ++i) order.push_back(place(p - i, i));
  for (int i = 1; i < p; ++i) order.push_back(place(0, p - i));
  if (p > 2) order.push_back(place(1, 1));
  if (p > 3) order.insert(order.end(), {place(2, 1), place(1, 2)});
  return order;
}

std::vector<int> line_order(int p)
{
  std::vector<int> order{0, p};
  for (int i = 1; i < p; ++i) order.push_back(i);
  return order;
}

}  // namespace

std::vector<LatticeCell> lattice_cells(const ElementBlock& block, int step)
{
  const int p = block.order;
  if (block.shape == Shape::line) return line_cells(p, step);
  const bool triangle = block.shape == Shape::triangle;
  const Lattice place(block);
  std::vector<LatticeCell> cells;
  for (int j = 0; j < p; j += step) {
    for (int i = 0; i + (triangle ? j : 0) < p; i += step) {
      const int a = place(i, j), b = place(i + step, j), d = place(i, j + step);
      if (!triangle) {
        cells.push_back({a, b, place(i + step, j + step), d});
        continue;
      }
      cells.push_back({a, b, d, d});
      if (i + j + 2 * step > p) continue;
      const int c = place(i + step, j + step);
      cells.push_back({b, c, d, d});
    }
  }
  return cells;
}

std::vector<std::vector<int>> edges_of(const ElementBlock& block, int element)
{
  const int p = block.order;
  const std::span<const int> nodes = block.element_nodes(element);
  if (block.shape == Shape::line) return {{nodes.begin(), nodes.end()}};
  const bool triangle = block.shape == Shape::triangle;
  const Lattice place(block);
  std::vector<std::vector<int>> edges(triangle ? 3 : 4);
  for (int i = 0; i <= p; ++i) {
    edges[0].push_back(nodes[place(i, 0)]);
    edges[1].push_back(nodes[place(0, i)]);
    edges[2].push_back(nodes[triangle ? place(p - i, i) : place(p, i)]);
    if (!triangle) edges[3].push_back(nodes[place(i, p)]);
  }
  return edges;
}

std::vector<std::vector<int>> edges_in(const Mesh& mesh, const Group& group)
{
  std::vector<char> is_member(mesh.positions.size(), 0);
  for (const int node : group.nodes) is_member[node] = 1;
  const auto has = [&](int node) { return is_member[node] != 0; };
  std::set<std::vector<int>> seen;
  std::vector<std::vector<int>> edges;
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      if (std::ranges::none_of(block.element_nodes(e), has)) continue;
      for (std::vector<int>& edge : edges_of(block, e)) {
        if (!std::ranges::all_of(edge, has)) continue;
        std::vector<int> key = edge;
        std::ranges::sort(key);
        if (seen.insert(key).second) edges.push_back(std::move(edge));
      }
    }
  }
  return edges;
}

std::vector<int> corners_first(Shape shape, int order)
{
  if (shape == Shape::line) return line_order(order);
  return shape == Shape::triangle ? triangle_order(order) : quadrilateral_order(order);
}

}  // namespace chladni::mesh
