#include "mesh/repetition.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "mesh/node_grid.hpp"
#include "mesh/sectors.hpp"

namespace chladni::mesh {

namespace {

using Point = std::array<double, 3>;

/// Where a turn by one sector takes nodes and elements; empty where it does not.
class Turn {
 public:
  Turn(const Mesh& mesh, const NodeGrid& grid, int count) : mesh_(mesh)
  {
    const Sectors sectors{.count = count, .pairs = {}};
    for (const Point& x : mesh.positions) {
      node_.push_back(grid.near(turned(sectors, x)));
      if (node_.back() < 0) return;
    }
    takes_nodes_ = true;
  }

  bool takes_mesh_to_itself() const
  {
    if (!takes_nodes_) return false;
    for (const Group& group : mesh_.groups)
      if (!takes_to_itself(group)) return false;
    return std::ranges::all_of(mesh_.blocks,
                               [&](const ElementBlock& block) { return !images(block).empty(); });
  }

  /// The element that each becomes; empty where one becomes none, or one of another group.
  std::vector<int> images(const ElementBlock& block) const
  {
    std::map<std::vector<int>, int> element_of;
    for (int e = 0; e < block.n_elements(); ++e) element_of.emplace(key(block, e, false), e);
    std::vector<int> image;
    for (int e = 0; e < block.n_elements(); ++e) {
      const auto found = element_of.find(key(block, e, true));
      if (found == element_of.end() || block.group[e] != block.group[found->second]) return {};
      image.push_back(found->second);
    }
    return image;
  }

 private:
  /// Its nodes, or those that these become, in ascending order.
  std::vector<int> key(const ElementBlock& block, int e, bool after) const
  {
    const auto nodes = block.element_nodes(e);
    std::vector<int> sorted(nodes.begin(), nodes.end());
    if (after)
      for (int& node : sorted) node = node_[std::size_t(node)];
    std::ranges::sort(sorted);
    return sorted;
  }

  bool takes_to_itself(const Group& group) const
  {
    std::vector<int> before = group.nodes, after;
    for (const int node : before) after.push_back(node_[std::size_t(node)]);
    std::ranges::sort(before);
    std::ranges::sort(after);
    return before == after;
  }

  const Mesh& mesh_;
  std::vector<int> node_;
  bool takes_nodes_ = false;
};

/// Turned nodes meet nodes to that, m: the digits of a mesh file.
double meeting(const Mesh& mesh)
{
  constexpr double digits = 1e-6;
  return digits * outer_radius(mesh);
}

/// Angle of the middle of an element from the x axis on, rad; a little below it counts as on it.
double angle_of(const Mesh& mesh, const ElementBlock& block, int e)
{
  constexpr double digits = 1e-6;
  Point sum{};
  for (const int node : block.element_nodes(e))
    for (std::size_t c = 0; c < 3; ++c) sum[c] += mesh.positions[node][c];
  const double angle = std::atan2(sum[1], sum[0]);
  return angle < -digits ? angle + 2.0 * std::numbers::pi : angle;
}

/// Of each element and its images the one with the least angle.
std::vector<int> chosen_elements(const Mesh& mesh, const ElementBlock& block,
                                 const std::vector<int>& image)
{
  std::vector<int> chosen;
  std::vector<bool> is_known(image.size(), false);
  for (int first = 0; first < block.n_elements(); ++first) {
    if (is_known[std::size_t(first)]) continue;
    int least = first;
    for (int e = first; !is_known[std::size_t(e)]; e = image[std::size_t(e)]) {
      is_known[std::size_t(e)] = true;
      if (angle_of(mesh, block, e) < angle_of(mesh, block, least)) least = e;
    }
    chosen.push_back(least);
  }
  std::ranges::sort(chosen);
  return chosen;
}

void keep(ElementBlock& block, const std::vector<int>& elements)
{
  ElementBlock kept{.shape = block.shape,
                    .order = block.order,
                    .nodes_per_element = block.nodes_per_element,
                    .numbers = {},
                    .nodes = {},
                    .group = {}};
  for (const int e : elements) {
    const auto nodes = block.element_nodes(e);
    kept.numbers.push_back(block.numbers[std::size_t(e)]);
    kept.nodes.insert(kept.nodes.end(), nodes.begin(), nodes.end());
    kept.group.push_back(block.group[std::size_t(e)]);
  }
  block = std::move(kept);
}

}  // namespace

int n_repetitions(const Mesh& mesh)
{
  constexpr int most = 10000;
  const double radius = outer_radius(mesh);
  int common = 0;  // the number of copies divides that of all elements and all nodes off the axis
  for (const ElementBlock& block : mesh.blocks) common = std::gcd(common, block.n_elements());
  const auto n_off_axis = static_cast<int>(std::ranges::count_if(
      mesh.positions, [&](const Point& x) { return !is_on_axis(x, radius); }));
  common = std::gcd(common, n_off_axis);
  const NodeGrid grid(mesh.positions, meeting(mesh));
  for (int count = std::min(common, most); count > 1; --count)
    if (common % count == 0 && Turn(mesh, grid, count).takes_mesh_to_itself()) return count;
  return 1;
}

Mesh one_sector(const Mesh& mesh, int count)
{
  const NodeGrid grid(mesh.positions, meeting(mesh));
  const Turn turn(mesh, grid, count);
  Mesh sector = mesh;
  for (std::size_t i = 0; i < mesh.blocks.size(); ++i)
    keep(sector.blocks[i], chosen_elements(mesh, mesh.blocks[i], turn.images(mesh.blocks[i])));
  drop_unused_nodes(sector);
  find_sector_edges(sector, count);
  return sector;
}

}  // namespace chladni::mesh
