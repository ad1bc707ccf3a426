#include "mesh/sectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "common/error.hpp"
#include "mesh/node_grid.hpp"

namespace chladni::mesh {

namespace {

using Point = std::array<double, 3>;

double distance(const Point& a, const Point& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Corners of a surface element, in order around it.
std::vector<int> corners(const ElementBlock& block, int element)
{
  const auto nodes = block.element_nodes(element);
  const int p = block.order, last = block.nodes_per_element - 1;
  if (block.shape == Shape::triangle) return {nodes[0], nodes[p], nodes[last]};
  return {nodes[0], nodes[p], nodes[last], nodes[last - p]};
}

using Segment = std::array<int, 2>;  ///< corner nodes, the lesser first

/// The sides of surface elements that no other element shares.
std::vector<Segment> boundary(const Mesh& mesh)
{
  std::map<Segment, int> uses;
  for (const ElementBlock& block : mesh.blocks) {
    if (block.shape == Shape::line) continue;
    for (int e = 0; e < block.n_elements(); ++e) {
      const std::vector<int> around = corners(block, e);
      for (std::size_t i = 0; i < around.size(); ++i) {
        const auto [a, b] = std::minmax(around[i], around[(i + 1) % around.size()]);
        ++uses[{a, b}];
      }
    }
  }
  std::vector<Segment> single;
  for (const auto& [segment, n] : uses)
    if (n == 1) single.push_back(segment);
  return single;
}

double distance_to(const Mesh& mesh, const Segment& segment, const Point& x)
{
  const Point &a = mesh.positions[segment[0]], &b = mesh.positions[segment[1]];
  double along = 0.0;
  for (std::size_t c = 0; c < 3; ++c) along += (x[c] - a[c]) * (b[c] - a[c]);
  const double length = distance(a, b);
  const double t = std::clamp(along / (length * length), 0.0, 1.0);
  return distance(x,
                  {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])});
}

std::string place(const Mesh& mesh, int node)
{
  const Point& x = mesh.positions[node];
  return fmt::format("node {} ({:.6g}, {:.6g}, {:.6g})", mesh.node_numbers[node], x[0], x[1], x[2]);
}

double shortest(const Mesh& mesh, const std::vector<Segment>& segments)
{
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : segments)
    least = std::min(least, distance(mesh.positions[a], mesh.positions[b]));
  return least;
}

/// Corners of the boundary that a turn to either side takes onto the boundary, but onto no node.
/// @param is_known  nodes with a partner, of either edge
void refuse_edges_that_do_not_match(const Mesh& mesh, const std::vector<Segment>& segments,
                                    const std::vector<bool>& is_known)
{
  constexpr double of_side = 0.05;  // cut edges are hardly bent over one element
  constexpr double of_width = 0.1;  // of the sector: a corner within it is on no cut edge
  const double turn = 2.0 * std::numbers::pi / mesh.sectors.count;
  int worst = -1;
  double largest = 0.0;
  std::vector<int> ends;
  for (const auto& [a, b] : segments) ends.insert(ends.end(), {a, b});
  std::ranges::sort(ends);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (const int node : ends) {
    if (is_known[node] || is_on_axis(mesh.positions[node], outer_radius(mesh))) continue;
    const Point& here = mesh.positions[node];
    const double width = turn * std::hypot(here[0], here[1]);
    for (const int to : {1, -1}) {
      const Point x = turned(mesh.sectors, here, to);
      for (const Segment& segment : segments) {
        const double length = distance(mesh.positions[segment[0]], mesh.positions[segment[1]]);
        if (distance_to(mesh, segment, x) > std::min(of_side * length, of_width * width)) continue;
        const double miss = std::min(distance(mesh.positions[segment[0]], x),
                                     distance(mesh.positions[segment[1]], x));
        if (miss > largest) {
          largest = miss;
          worst = node;
        }
      }
    }
  }
  if (worst < 0) return;
  throw Error(fmt::format(
      "sectors = {}: the cut edges do not match: {}, turned by {:.6g} degrees, is {:.3g} m away "
      "from the next node of the other edge; make the second edge of the sector a copy of the "
      "first (in Gmsh: Periodic Curve ... Rotate)",
      mesh.sectors.count, place(mesh, worst), 360.0 / mesh.sectors.count, largest));
}

void refuse_wider_mesh(const Mesh& mesh, const std::vector<bool>& is_low)
{
  for (const auto& [low, high] : mesh.sectors.pairs) {
    if (!is_low[high]) continue;
    throw Error(fmt::format(
        "sectors = {}: the mesh is wider than one sector of {:.6g} degrees: turned by that, {} "
        "meets a node, and that node meets one again; mesh one sector only, or correct the number",
        mesh.sectors.count, 360.0 / mesh.sectors.count, place(mesh, low)));
  }
}

}  // namespace

void check_pattern_of_sectors(int count, Pattern pattern)
{
  if (count == 1 || pattern == Pattern::structured) return;
  throw Error(fmt::format(
      "sectors = {}: Gmsh's elements are not alike in all sectors; take pattern = \"structured\"",
      count));
}

Point turned(const Sectors& sectors, const Point& x, int turns)
{
  const double angle = 2.0 * std::numbers::pi * turns / sectors.count;
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
}

double outer_radius(const Mesh& mesh)
{
  double radius = 0.0;
  for (const Point& x : mesh.positions) radius = std::max(radius, std::hypot(x[0], x[1]));
  return radius;
}

bool is_on_axis(const Point& x, double length)
{
  constexpr double digits = 1e-7;
  return std::hypot(x[0], x[1]) < digits * length;
}

void find_sector_edges(Mesh& mesh, int count)
{
  constexpr double of_side = 1e-3;  // no element is bent by that
  constexpr double round_off = 1e-9;
  mesh.sectors = {.count = count, .pairs = {}};
  if (count == 1) return;
  const std::vector<Segment> segments = boundary(mesh);
  const double radius = outer_radius(mesh);
  const NodeGrid grid(mesh.positions, std::min(of_side * shortest(mesh, segments), radius));
  std::vector<bool> is_low(std::size_t(mesh.n_nodes()), false);
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    if (is_on_axis(mesh.positions[node], radius)) continue;
    const int high = grid.near(turned(mesh.sectors, mesh.positions[node]));
    if (high < 0) continue;
    is_low[node] = true;
    mesh.sectors.pairs.push_back({node, high});
  }
  refuse_wider_mesh(mesh, is_low);
  std::vector<bool> is_known = is_low;
  for (const auto& [low, high] : mesh.sectors.pairs) is_known[high] = true;
  refuse_edges_that_do_not_match(mesh, segments, is_known);
  if (mesh.sectors.pairs.empty()) {
    throw Error(fmt::format(
        "sectors = {}: no node of the mesh meets another one after a turn by {:.6g} degrees about "
        "the z axis; mesh one sector from one cut edge to the other, or correct the number",
        count, 360.0 / count));
  }
  double largest_move = 0.0;
  for (const auto& [low, high] : mesh.sectors.pairs) {
    const Point x = turned(mesh.sectors, mesh.positions[low]);
    largest_move = std::max(largest_move, distance(x, mesh.positions[high]));
    mesh.positions[high] = x;
  }
  if (largest_move > round_off * radius) {
    mesh.notes.push_back(fmt::format(
        "sectors: nodes of the second cut edge were moved onto the turned first one, by "
        "{:.2g} m at most",
        largest_move));
  }
}

}  // namespace chladni::mesh
