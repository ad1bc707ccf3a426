#include "mesh/mesh_repair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <span>

#include "common/error.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

namespace {

using Vector = std::array<double, 3>;

double distance(const Vector& a, const Vector& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double extent(const Mesh& mesh)
{
  Vector low = mesh.positions.front();
  Vector high = low;
  for (const Vector& x : mesh.positions) {
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], x[c]);
      high[c] = std::max(high[c], x[c]);
    }
  }
  return distance(low, high);
}

/// Between neighbours in the rows of an element's nodes; zero ones are another matter.
double least_distance_in_elements(const Mesh& mesh)
{
  double least = std::numeric_limits<double>::infinity();
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      const auto nodes = block.element_nodes(e);
      for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        const double d = distance(mesh.positions[nodes[k]], mesh.positions[nodes[k + 1]]);
        if (d > 0.0) least = std::min(least, d);
      }
    }
  }
  return least;
}

std::string list(const Mesh& mesh, const std::vector<std::array<int, 2>>& pairs)
{
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(pairs.size(), 10); ++i) {
    const auto [a, b] = pairs[i];
    text +=
        fmt::format("{}{} and {}", i == 0 ? "" : ", ", mesh.node_numbers[a], mesh.node_numbers[b]);
  }
  return pairs.size() > 10 ? text + fmt::format(" ... ({} pairs)", pairs.size()) : text;
}

void check_no_collapse(const Mesh& mesh, double tolerance)
{
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      const auto nodes = block.element_nodes(e);
      if (std::set<int>(nodes.begin(), nodes.end()).size() == nodes.size()) continue;
      throw Error(fmt::format(
          "element {} has two nodes within the tolerance of {:.3g} m and would collapse; make "
          "merge_tolerance smaller, or repair the mesh",
          block.numbers[e], tolerance));
    }
  }
}

/// Nodes to which others were merged take over their elements and groups.
void replace_nodes(Mesh& mesh, const std::vector<int>& by)
{
  for (ElementBlock& block : mesh.blocks)
    for (int& node : block.nodes) node = by[node];
  for (Group& group : mesh.groups) {
    for (int& node : group.nodes) node = by[node];
    std::ranges::sort(group.nodes);
    group.nodes.erase(std::unique(group.nodes.begin(), group.nodes.end()), group.nodes.end());
  }
  for (Equation& equation : mesh.equations)
    for (Equation::Term& term : equation.terms) term.node = by[term.node];
}

/// Pairs that neither a coupling joins nor equations: not both of their nodes are in one of the
/// groups or in equations, and none belongs to equations alone.
std::vector<std::array<int, 2>> without_coupled(std::vector<std::array<int, 2>> pairs,
                                                const Mesh& mesh,
                                                const std::vector<std::string>& groups)
{
  std::set<int> coupled;
  for (const Group& group : mesh.groups)
    if (std::ranges::find(groups, group.name) != groups.end())
      coupled.insert(group.nodes.begin(), group.nodes.end());
  std::set<int> alone;
  for (const Equation& equation : mesh.equations)
    for (const Equation::Term& term : equation.terms) alone.insert(term.node);
  coupled.insert(alone.begin(), alone.end());
  for (const ElementBlock& block : mesh.blocks)
    for (const int node : block.nodes) alone.erase(node);
  std::erase_if(pairs, [&](const auto& pair) {
    return (coupled.contains(pair[0]) && coupled.contains(pair[1])) || alone.contains(pair[0]) ||
           alone.contains(pair[1]);
  });
  return pairs;
}

}  // namespace

std::vector<std::array<int, 2>> coincident_nodes(const Mesh& mesh, double tolerance)
{
  // Along a skew direction the nodes of a regular mesh lie apart, so that few come into question.
  const auto along = [&](int i) {
    const Vector& x = mesh.positions[i];
    return 0.6123724 * x[0] + 0.5412659 * x[1] + 0.5762212 * x[2];
  };
  std::vector<std::pair<double, int>> sorted(mesh.positions.size());
  for (int i = 0; i < mesh.n_nodes(); ++i) sorted[i] = {along(i), i};
  std::ranges::sort(sorted);
  std::vector<int> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto first_of_heap = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    for (std::size_t j = i + 1; j < sorted.size(); ++j) {
      if (sorted[j].first - sorted[i].first > tolerance) break;
      const int a = sorted[i].second;
      const int b = sorted[j].second;
      if (distance(mesh.positions[a], mesh.positions[b]) > tolerance) continue;
      const auto [low, high] = std::minmax({first_of_heap(a), first_of_heap(b)});
      parent[high] = low;
    }
  }
  std::vector<std::array<int, 2>> pairs;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (first_of_heap(i) != i) pairs.push_back({first_of_heap(i), i});
  return pairs;
}

Mesh treat_coincident_nodes(Mesh mesh, const MeshOptions& options)
{
  const Coincident treatment = options.coincident_nodes;
  if (treatment == Coincident::keep) return mesh;
  const double within = options.merge_tolerance.value_or(
      std::min(1e-6 * extent(mesh), 0.1 * least_distance_in_elements(mesh)));
  const auto pairs = without_coupled(coincident_nodes(mesh, within), mesh, options.coupled_groups);
  if (pairs.empty()) return mesh;
  if (treatment == Coincident::refuse) {
    throw Error(fmt::format(
        "nodes of unconnected elements stand at one place (within {:.3g} m): {}; set "
        "coincident_nodes = \"merge\" in [mesh] to join them, or \"keep\" to leave the gap",
        within, list(mesh, pairs)));
  }
  std::vector<int> by(mesh.positions.size());
  std::iota(by.begin(), by.end(), 0);
  for (const auto& [kept, merged] : pairs) by[merged] = kept;
  replace_nodes(mesh, by);
  check_no_collapse(mesh, within);
  drop_unused_nodes(mesh, options.coupled_groups);
  mesh.notes.push_back(
      fmt::format("{} coincident nodes were merged (within {:.3g} m)", pairs.size(), within));
  return mesh;
}

namespace {

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

namespace {

const double cosine_limit = std::cos(165.0 * std::numbers::pi / 180.0);

/// Lattice place of column i, row j.
int lattice_place(int order, int i, int j)
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
  const Vector& x = mesh.positions[nodes[lattice_place(p, i, j)]];
  const int next_i = i == 0 ? 1 : p - 1;
  const int next_j = j == 0 ? 1 : p - 1;
  const Vector a = minus(mesh.positions[nodes[lattice_place(p, next_i, j)]], x);
  const Vector b = minus(mesh.positions[nodes[lattice_place(p, i, next_j)]], x);
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
      first.push_back(falling ? lattice_place(p, i, j) : lattice_place(p, p - j, i));
      second.push_back(falling ? lattice_place(p, p - i, p - j) : lattice_place(p, j, p - i));
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

namespace {

bool has_section(const Mesh& mesh, Shape shape, int group, const MeshOptions& options)
{
  if (group < 0) return false;
  const auto& names = is_solid(shape)        ? options.solid_groups
                      : shape == Shape::line ? options.line_groups
                                             : options.shell_groups;
  return std::ranges::find(names, mesh.groups[std::size_t(group)].name) != names.end();
}

/// The group of an element that stands in the file twice, as element `first` and `other`.
int common_group(const Mesh& mesh, const ElementBlock& block, const std::array<int, 2>& pair,
                 const MeshOptions& options)
{
  const int first = block.group[std::size_t(pair[0])], other = block.group[std::size_t(pair[1])];
  if (first == other || !has_section(mesh, block.shape, other, options))
    return first < 0 ? other : first;
  if (!has_section(mesh, block.shape, first, options)) return other;
  throw Error(fmt::format(
      "elements {} and {} have the same nodes, and are in the groups \"{}\" and \"{}\", which have "
      "a section each; take one of them out",
      block.numbers[std::size_t(pair[0])], block.numbers[std::size_t(pair[1])],
      mesh.groups[std::size_t(first)].name, mesh.groups[std::size_t(other)].name));
}

void erase_elements(ElementBlock& block, const std::vector<char>& is_erased)
{
  const auto width = static_cast<std::ptrdiff_t>(block.nodes_per_element);
  std::size_t kept = 0;
  for (std::size_t e = 0; e < is_erased.size(); ++e) {
    if (is_erased[e] != 0) continue;
    block.numbers[kept] = block.numbers[e];
    block.group[kept] = block.group[e];
    std::copy_n(block.nodes.begin() + std::ptrdiff_t(e) * width, width,
                block.nodes.begin() + std::ptrdiff_t(kept) * width);
    ++kept;
  }
  block.numbers.resize(kept);
  block.group.resize(kept);
  block.nodes.resize(kept * std::size_t(width));
}

}  // namespace

std::vector<std::array<int, 2>> doubled_elements(const ElementBlock& block)
{
  const auto width = static_cast<std::size_t>(block.nodes_per_element);
  std::vector<int> ascending = block.nodes;
  const auto nodes_of = [&](int e) {
    return std::span(ascending).subspan(std::size_t(e) * width, width);
  };
  for (int e = 0; e < block.n_elements(); ++e) std::ranges::sort(nodes_of(e));
  std::vector<int> order(block.numbers.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](int a, int b) {
    return std::ranges::lexicographical_compare(nodes_of(a), nodes_of(b));
  });
  std::vector<std::array<int, 2>> pairs;
  std::size_t first = 0;
  for (std::size_t i = 1; i < order.size(); ++i)
    if (std::ranges::equal(nodes_of(order[i]), nodes_of(order[first])))
      pairs.push_back({order[first], order[i]});
    else
      first = i;
  std::ranges::sort(pairs, {}, [](const auto& pair) { return pair[1]; });
  return pairs;
}

void merge_doubled_elements(Mesh& mesh, const MeshOptions& options)
{
  for (ElementBlock& block : mesh.blocks) {
    const std::vector<std::array<int, 2>> pairs = doubled_elements(block);
    if (pairs.empty()) continue;
    std::vector<char> is_erased(block.numbers.size(), 0);
    for (const auto& [first, other] : pairs) {
      block.group[std::size_t(first)] = common_group(mesh, block, {first, other}, options);
      is_erased[std::size_t(other)] = 1;
    }
    mesh.notes.push_back(fmt::format(
        "{} elements have the nodes of another one of their type (the first are {} and {}): they "
        "are one element in several groups",
        pairs.size(), block.numbers[std::size_t(pairs[0][0])],
        block.numbers[std::size_t(pairs[0][1])]));
    erase_elements(block, is_erased);
  }
}

}  // namespace chladni::mesh
