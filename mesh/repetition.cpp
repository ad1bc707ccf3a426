#include "mesh/repetition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "common/error.hpp"
#include "mesh/node_grid.hpp"
#include "mesh/sectors.hpp"

namespace chladni::mesh {

namespace {

using Point = std::array<double, 3>;

using Motion = std::function<Point(const Point&)>;

Motion turn_by_one_of(int count)
{
  return [sectors = Sectors{.count = count, .pairs = {}}](const Point& x) {
    return turned(sectors, x);
  };
}

/// At the plane through the z axis with this angle.
Motion reflection_at(double angle)
{
  return [c = std::cos(2.0 * angle), s = std::sin(2.0 * angle)](const Point& x) {
    return Point{c * x[0] + s * x[1], s * x[0] - c * x[1], x[2]};
  };
}

/// Where a turn or a reflection takes nodes and elements; empty where it does not.
class Images {
 public:
  Images(const Mesh& mesh, const NodeGrid& grid, const Motion& motion) : mesh_(mesh)
  {
    for (const Point& x : mesh.positions) {
      node_.push_back(grid.near(motion(x)));
      if (node_.back() < 0) return;
    }
    takes_nodes_ = true;
  }

  bool take_nodes_to_nodes() const { return takes_nodes_; }

  bool take_mesh_to_itself() const
  {
    if (!takes_nodes_) return false;
    for (const Group& group : mesh_.groups)
      if (!takes_to_itself(group)) return false;
    return std::ranges::all_of(mesh_.blocks,
                               [&](const ElementBlock& block) { return !of(block).empty(); });
  }

  /// The element that each becomes; empty where one becomes none, or one of another group.
  std::vector<int> of(const ElementBlock& block) const
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

/// Angle of the middle of an element from the start on, rad; a little below it counts as on it.
double angle_of(const Mesh& mesh, const ElementBlock& block, int e, double start)
{
  constexpr double digits = 1e-6;
  Point sum{};
  for (const int node : block.element_nodes(e))
    for (std::size_t c = 0; c < 3; ++c) sum[c] += mesh.positions[node][c];
  double angle = std::atan2(sum[1], sum[0]) - start;
  while (angle < -digits) angle += 2.0 * std::numbers::pi;
  return angle;
}

/// Of each element and its images the one with the least angle.
std::vector<int> chosen_elements(const Mesh& mesh, const ElementBlock& block,
                                 const std::vector<int>& image, double start)
{
  std::vector<int> chosen;
  std::vector<bool> is_known(image.size(), false);
  for (int first = 0; first < block.n_elements(); ++first) {
    if (is_known[std::size_t(first)]) continue;
    int least = first;
    for (int e = first; !is_known[std::size_t(e)]; e = image[std::size_t(e)]) {
      is_known[std::size_t(e)] = true;
      if (angle_of(mesh, block, e, start) < angle_of(mesh, block, least, start)) least = e;
    }
    chosen.push_back(least);
  }
  std::ranges::sort(chosen);
  return chosen;
}

/// The elements of a sector, block by block, and where one turn takes all elements.
struct Cut {
  std::vector<std::vector<int>> turned;
  std::vector<std::vector<int>> chosen;
};

Cut cut_at(const Mesh& mesh, std::vector<std::vector<int>> turned, double start)
{
  Cut cut{.turned = std::move(turned), .chosen = {}};
  for (std::size_t i = 0; i < mesh.blocks.size(); ++i)
    cut.chosen.push_back(chosen_elements(mesh, mesh.blocks[i], cut.turned[i], start));
  return cut;
}

/// Whether a reflection takes the chosen elements to themselves.
bool is_own_image(const Mesh& mesh, const Cut& cut, const Images& reflected)
{
  for (std::size_t i = 0; i < mesh.blocks.size(); ++i) {
    const std::vector<int> image = reflected.of(mesh.blocks[i]);
    const auto stays = [&](int e) {
      return std::ranges::binary_search(cut.chosen[i], image[std::size_t(e)]);
    };
    if (image.empty() || !std::ranges::all_of(cut.chosen[i], stays)) return false;
  }
  return true;
}

/// Angles of some nodes at one distance and height, of which there are fewest; reflections of the
/// body take them to each other.
std::vector<double> angles_of_fewest(const Mesh& mesh)
{
  constexpr double digits = 1e-5;
  const double radius = outer_radius(mesh), width = digits * radius;
  std::map<std::array<std::int64_t, 2>, std::vector<double>> circles;
  for (const Point& x : mesh.positions) {
    if (is_on_axis(x, radius)) continue;
    circles[{std::llround(std::hypot(x[0], x[1]) / width), std::llround(x[2] / width)}].push_back(
        std::atan2(x[1], x[0]));
  }
  return std::ranges::min_element(circles, {},
                                  [](const auto& circle) { return circle.second.size(); })
      ->second;
}

/// Where a sector begins that is its own image, if there is such a cut: on a plane at which the
/// whole body is its own image, without an element in it.
std::optional<double> start_of_own_image(const Mesh& mesh, const NodeGrid& grid, int count,
                                         const Cut& along_x)
{
  const double half = std::numbers::pi / count;
  const auto begins = [&](double start) {
    const Images reflected(mesh, grid, reflection_at(start + half));
    return reflected.take_mesh_to_itself() &&
           is_own_image(mesh, cut_at(mesh, along_x.turned, start), reflected);
  };
  if (begins(0.0)) return 0.0;
  std::vector<double> angles = angles_of_fewest(mesh);
  std::vector<double> tried;
  for (const double angle : angles) {
    double plane = std::fmod(0.5 * (angles.front() + angle), half);
    if (plane < 0.0) plane += half;
    const bool is_known = std::ranges::any_of(
        tried, [&](double other) { return std::abs(std::remainder(other - plane, half)) < 1e-9; });
    if (is_known) continue;
    tried.push_back(plane);
    for (const double start : {plane, plane + half})
      if (begins(start)) return start;
  }
  return std::nullopt;
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
    if (common % count == 0 && Images(mesh, grid, turn_by_one_of(count)).take_mesh_to_itself())
      return count;
  return 1;
}

Mesh one_sector(const Mesh& mesh, int count)
{
  const NodeGrid grid(mesh.positions, meeting(mesh));
  const Images turned(mesh, grid, turn_by_one_of(count));
  std::vector<std::vector<int>> images;
  for (const ElementBlock& block : mesh.blocks) {
    if (turned.take_nodes_to_nodes()) images.push_back(turned.of(block));
    if (images.empty() || std::ssize(images.back()) != block.n_elements()) {
      throw Error(
          fmt::format("sectors = {}: a turn by {:.6g} degrees does not take the mesh to itself",
                      count, 360.0 / count));
    }
  }
  Cut cut = cut_at(mesh, std::move(images), 0.0);
  if (const auto start = start_of_own_image(mesh, grid, count, cut); start && *start != 0.0)
    cut = cut_at(mesh, std::move(cut.turned), *start);
  Mesh sector = mesh;
  for (std::size_t i = 0; i < mesh.blocks.size(); ++i) keep(sector.blocks[i], cut.chosen[i]);
  drop_unused_nodes(sector);
  find_sector_edges(sector, count);
  return sector;
}

}  // namespace chladni::mesh
