#include "mesh/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/error.hpp"

namespace chladni::mesh {

namespace {

/// Adds the nodes that a station sweeps.
/// @return the first of them
int add_row(Swept& swept, const Path& path, const Station& station)
{
  const int first = swept.mesh.n_nodes();
  const double n_intervals = double(path.n_elements) * path.order;
  for (int k = 0; k < swept.n_columns; ++k) {
    swept.mesh.node_numbers.push_back(first + k + 1);
    swept.mesh.positions.push_back(path.position(station, k / n_intervals));
  }
  return first;
}

/// The row of an end of an element, which profiles may share.
int shared_row(Swept& swept, const Path& path, const Station& station)
{
  const auto found = swept.first_node.find(station);
  if (found != swept.first_node.end()) return found->second;
  return swept.first_node[station] = add_row(swept, path, station);
}

/// First nodes of the order + 1 rows from one end of an element to the other.
std::vector<int> rows_between(Swept& swept, const Path& path, const Station& a, const Station& b)
{
  std::vector<int> rows{shared_row(swept, path, a)};
  for (int k = 1; k < path.order; ++k) {
    const double s = double(k) / path.order;
    rows.push_back(add_row(swept, path, {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])}));
  }
  rows.push_back(shared_row(swept, path, b));
  return rows;
}

/// The elements between two ends of a profile's element, all along the path.
void add_strip(Swept& swept, const Path& path, const std::vector<int>& rows, int group)
{
  ElementBlock& block = swept.mesh.blocks.front();
  for (int e = 0; e < path.n_elements; ++e) {
    block.numbers.push_back(block.n_elements() + 1);
    block.group.push_back(group);
    for (int j = 0; j <= path.order; ++j) {
      const int column = (e * path.order + j) % swept.n_columns;
      for (const int row : rows) block.nodes.push_back(row + column);
    }
  }
}

void add_profile(Swept& swept, const Path& path, const Profile& profile)
{
  const auto group = static_cast<int>(swept.mesh.groups.size());
  std::vector<int> first_nodes;
  for (std::size_t i = 0; i + 1 < profile.stations.size(); ++i) {
    const std::vector<int> rows =
        rows_between(swept, path, profile.stations[i], profile.stations[i + 1]);
    add_strip(swept, path, rows, group);
    first_nodes.insert(first_nodes.end(), rows.begin(), rows.end());
  }
  std::ranges::sort(first_nodes);
  first_nodes.erase(std::unique(first_nodes.begin(), first_nodes.end()), first_nodes.end());
  Group surface{.name = profile.group, .dimension = 2, .nodes = {}};
  for (const int first : first_nodes)
    for (int k = 0; k < swept.n_columns; ++k) surface.nodes.push_back(first + k);
  swept.mesh.groups.push_back(std::move(surface));
}

}  // namespace

Swept sweep(std::span<const Profile> profiles, const Path& path)
{
  const int p = path.order;
  Swept swept{
      .mesh = {}, .first_node = {}, .n_columns = path.n_elements * p + (path.closed ? 0 : 1)};
  swept.mesh.blocks.push_back({.shape = Shape::quadrilateral,
                               .order = p,
                               .nodes_per_element = (p + 1) * (p + 1),
                               .numbers = {},
                               .nodes = {},
                               .group = {}});
  for (const Profile& profile : profiles) add_profile(swept, path, profile);
  return swept;
}

void add_row_group(Swept& swept, const Station& station, const std::string& name)
{
  Group row{.name = name, .dimension = 1, .nodes = {}};
  const int first = swept.first_node.at(station);
  for (int k = 0; k < swept.n_columns; ++k) row.nodes.push_back(first + k);
  swept.mesh.groups.push_back(std::move(row));
}

void add_column_group(Swept& swept, int k, const std::string& name)
{
  Group column{.name = name, .dimension = 1, .nodes = {}};
  for (int node = k; node < swept.mesh.n_nodes(); node += swept.n_columns)
    column.nodes.push_back(node);
  swept.mesh.groups.push_back(std::move(column));
}

std::vector<double> cut(const std::vector<double>& at, double size)
{
  std::vector<double> breaks;
  for (const double x : at) {
    // What differs by round-off alone is one place; the first that names it counts.
    const auto same = [&](double b) { return std::abs(b - x) < 1e-9 * size; };
    if (std::ranges::none_of(breaks, same)) breaks.push_back(x);
  }
  std::ranges::sort(breaks);
  std::vector<double> cuts{breaks.front()};
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double width = breaks[i + 1] - breaks[i];
    const int n = std::max(1, static_cast<int>(std::lround(width / size)));
    for (int k = 1; k < n; ++k) cuts.push_back(breaks[i] + width * k / n);
    cuts.push_back(breaks[i + 1]);
  }
  return cuts;
}

void check_edge_rows(double row, double distance)
{
  if (row > 0.0 && 2.0 * row < distance) return;
  throw Error(fmt::format(
      "edge_row: two rows of width {} m do not fit between edges {:.6g} m apart; make it smaller",
      row, distance));
}

std::vector<double> with_edge_rows(std::vector<double> breaks, double row)
{
  const auto [least, greatest] = std::ranges::minmax(breaks);
  check_edge_rows(row, greatest - least);
  breaks.push_back(least + row);
  breaks.push_back(greatest - row);
  return breaks;
}

int n_elements_around(double radius, double size, std::span<const RingOptions> rings, int sectors)
{
  const double wanted = std::max(12.0, 2.0 * std::numbers::pi * radius / size);
  std::int64_t divisor = sectors;
  for (const RingOptions& ring : rings) {
    divisor = std::lcm(divisor, std::int64_t(ring.nodes));
    if (double(divisor) > 4.0 * wanted) {
      throw Error(fmt::format(
          "ring \"{}\" asks for {} structured elements around the disc, the element size for "
          "{:.0f}; use pattern = \"unstructured\", or numbers of nodes that divide each other",
          ring.name, divisor, wanted));
    }
  }
  const auto m = static_cast<double>(divisor);
  const double least = std::ceil(12.0 / m) * m;
  return static_cast<int>(std::max(least, std::round(wanted / m) * m));
}

}  // namespace chladni::mesh
