#include "mesh/sectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "common/error.hpp"
#include "mesh/element_types.hpp"

namespace chladni::mesh {

namespace {

/// Finds points by position, with a grid of cells as wide as a tolerance.
class NodeGrid {
 public:
  /// @param points     must outlive this object; m
  /// @param tolerance  m
  NodeGrid(std::span<const std::array<double, 3>> points, double tolerance);

  /// The index of the nearest point within the tolerance; -1 if there is none.
  int near(const std::array<double, 3>& x) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell(const std::array<double, 3>& x) const;

  std::span<const std::array<double, 3>> points_;
  double tolerance_;
  std::map<Cell, std::vector<int>> cells_;
};

NodeGrid::NodeGrid(std::span<const std::array<double, 3>> points, double tolerance)
    : points_(points), tolerance_(tolerance)
{
  for (std::size_t i = 0; i < points_.size(); ++i)
    cells_[cell(points_[i])].push_back(static_cast<int>(i));
}

int NodeGrid::near(const std::array<double, 3>& x) const
{
  const Cell home = cell(x);
  int nearest = -1;
  double least = tolerance_;
  for (int i = 0; i < 27; ++i) {
    const auto found =
        cells_.find({home[0] + i % 3 - 1, home[1] + i / 3 % 3 - 1, home[2] + i / 9 - 1});
    if (found == cells_.end()) continue;
    for (const int point : found->second) {
      const auto& y = points_[std::size_t(point)];
      const double d = std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
      if (d > least) continue;
      least = d;
      nearest = point;
    }
  }
  return nearest;
}

NodeGrid::Cell NodeGrid::cell(const std::array<double, 3>& x) const
{
  return {std::int64_t(std::floor(x[0] / tolerance_)), std::int64_t(std::floor(x[1] / tolerance_)),
          std::int64_t(std::floor(x[2] / tolerance_))};
}

using Point = std::array<double, 3>;

double distance_of_points(const Point& a, const Point& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Corners of a surface element, in order around it.
std::vector<int> corner_nodes(const ElementBlock& block, int element)
{
  std::vector<int> around;
  for (const int k : corner_places(block)) around.push_back(block.element_nodes(element)[k]);
  return around;
}

using Segment = std::array<int, 2>;  ///< corner nodes, the lesser first

/// The sides of surface elements that no other element shares.
std::vector<Segment> boundary(const Mesh& mesh)
{
  std::map<Segment, int> uses;
  for (const ElementBlock& block : mesh.blocks) {
    if (!is_surface(block.shape)) continue;
    for (int e = 0; e < block.n_elements(); ++e) {
      const std::vector<int> around = corner_nodes(block, e);
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
  const double length = distance_of_points(a, b);
  const double t = std::clamp(along / (length * length), 0.0, 1.0);
  return distance_of_points(
      x, {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])});
}

std::string described_place(const Mesh& mesh, int node)
{
  const Point& x = mesh.positions[node];
  return fmt::format("node {} ({:.6g}, {:.6g}, {:.6g})", mesh.node_numbers[node], x[0], x[1], x[2]);
}

double shortest(const Mesh& mesh, const std::vector<Segment>& segments)
{
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : segments)
    least = std::min(least, distance_of_points(mesh.positions[a], mesh.positions[b]));
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
        const double length =
            distance_of_points(mesh.positions[segment[0]], mesh.positions[segment[1]]);
        if (distance_to(mesh, segment, x) > std::min(of_side * length, of_width * width)) continue;
        const double miss = std::min(distance_of_points(mesh.positions[segment[0]], x),
                                     distance_of_points(mesh.positions[segment[1]], x));
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
      mesh.sectors.count, described_place(mesh, worst), 360.0 / mesh.sectors.count, largest));
}

/// A free face of a solid.
struct FaceOnSkin {
  std::vector<int> corners;
  Point middle, normal;  ///< outwards, of length 1
  double side;           ///< the longest, m
};

std::vector<FaceOnSkin> skin_of_solids(const Mesh& mesh)
{
  std::vector<FaceOnSkin> skin;
  for (const FreeFace& face : free_faces(mesh)) {
    const int order = mesh.blocks[std::size_t(face.block)].order;
    const std::size_t n = std::ssize(face.nodes) == 3 * order ? 3 : 4;
    FaceOnSkin on{.corners = {face.nodes.begin(), face.nodes.begin() + std::ptrdiff_t(n)},
                  .middle = {},
                  .normal = {},
                  .side = 0.0};
    const auto x = [&](std::size_t k) { return mesh.positions[std::size_t(on.corners[k % n])]; };
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t c = 0; c < 3; ++c) on.middle[c] += x(k)[c] / double(n);
      on.side = std::max(on.side, distance_of_points(x(k), x(k + 1)));
    }
    on.normal = unit(cross(minus(x(1), x(0)), minus(x(n - 1), x(0))));
    skin.push_back(std::move(on));
  }
  return skin;
}

std::vector<Segment> sides_of(const std::vector<FaceOnSkin>& skin)
{
  std::vector<Segment> sides;
  for (const auto& [corners, middle, normal, side] : skin)
    for (std::size_t k = 0; k < corners.size(); ++k)
      sides.push_back({corners[k], corners[(k + 1) % corners.size()]});
  return sides;
}

/// Faces that a turn lays onto faces of the other side, but whose nodes meet none.
/// @param is_known  nodes with a partner, on either side
void refuse_faces_that_do_not_match(const Mesh& mesh, const std::vector<FaceOnSkin>& skin,
                                    const std::vector<bool>& is_known)
{
  constexpr double of_side = 0.05, opposite = -0.9;
  const double radius = outer_radius(mesh);
  double longest = 0.0;
  std::vector<Point> middles;
  for (const FaceOnSkin& face : skin) {
    middles.push_back(face.middle);
    longest = std::max(longest, face.side);
  }
  const NodeGrid grid(middles, std::max(longest, 1e-300));
  for (const FaceOnSkin& face : skin) {
    const auto alone = std::ranges::find_if(face.corners, [&](int node) {
      return !is_known[std::size_t(node)] && !is_on_axis(mesh.positions[std::size_t(node)], radius);
    });
    if (alone == face.corners.end()) continue;
    for (const int to : {1, -1}) {
      const Point x = turned(mesh.sectors, face.middle, to);
      const int near = grid.near(x);
      if (near < 0) continue;
      const FaceOnSkin& other = skin[std::size_t(near)];
      if (std::abs(dot(minus(x, other.middle), other.normal)) > of_side * other.side ||
          dot(turned(mesh.sectors, face.normal, to), other.normal) > opposite)
        continue;
      throw Error(fmt::format(
          "sectors = {}: the cut faces do not match: {} lies on one of them and, turned by {:.6g} "
          "degrees, on no node of the other; make the second face of the sector a copy of the "
          "first "
          "(in Gmsh: Periodic Surface ... Rotate)",
          mesh.sectors.count, described_place(mesh, *alone), 360.0 / mesh.sectors.count));
    }
  }
}

void refuse_wider_mesh(const Mesh& mesh, const std::vector<bool>& is_low)
{
  for (const auto& [low, high] : mesh.sectors.pairs) {
    if (!is_low[high]) continue;
    throw Error(fmt::format(
        "sectors = {}: the mesh is wider than one sector of {:.6g} degrees: turned by that, {} "
        "meets a node, and that node meets one again; mesh one sector only, or correct the number",
        mesh.sectors.count, 360.0 / mesh.sectors.count, described_place(mesh, low)));
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
  if (!mesh.equations.empty()) {
    throw Error(
        fmt::format("sectors = {}: {} is an equation between nodes, which a sector cannot have",
                    count, mesh.equations.front().place));
  }
  const std::vector<Segment> segments = boundary(mesh);
  const std::vector<FaceOnSkin> skin = skin_of_solids(mesh);
  const double radius = outer_radius(mesh);
  const double side = std::min(shortest(mesh, segments), shortest(mesh, sides_of(skin)));
  const NodeGrid grid(mesh.positions, std::min(of_side * side, radius));
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
  refuse_faces_that_do_not_match(mesh, skin, is_known);
  if (mesh.sectors.pairs.empty()) {
    throw Error(fmt::format(
        "sectors = {}: no node of the mesh meets another one after a turn by {:.6g} degrees about "
        "the z axis; mesh one sector from one cut edge to the other, or correct the number",
        count, 360.0 / count));
  }
  double largest_move = 0.0;
  for (const auto& [low, high] : mesh.sectors.pairs) {
    const Point x = turned(mesh.sectors, mesh.positions[low]);
    largest_move = std::max(largest_move, distance_of_points(x, mesh.positions[high]));
    mesh.positions[high] = x;
  }
  if (largest_move > round_off * radius) {
    mesh.notes.push_back(fmt::format(
        "sectors: nodes of the second cut edge were moved onto the turned first one, by "
        "{:.2g} m at most",
        largest_move));
  }
}

namespace {

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

void keep_elements(ElementBlock& block, const std::vector<int>& elements)
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
  if (!mesh.equations.empty()) return 1;  // which may join nodes of several copies
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
  for (std::size_t i = 0; i < mesh.blocks.size(); ++i)
    keep_elements(sector.blocks[i], cut.chosen[i]);
  drop_unused_nodes(sector);
  find_sector_edges(sector, count);
  return sector;
}

}  // namespace chladni::mesh
