#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/error.hpp"
#include "mesh/generators.hpp"

namespace chladni::mesh {

namespace {

double length_of(const BeamMeshOptions& options)
{
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) sum += std::pow(options.end[c] - options.start[c], 2);
  return std::sqrt(sum);
}

/// Ends and points in order, each once.
std::vector<double> stations(const BeamMeshOptions& options, double length)
{
  std::vector<double> distances{0.0, length};
  for (const BeamPoint& point : options.points) distances.push_back(point.distance);
  std::ranges::sort(distances);
  const auto same = [&](double a, double b) { return b - a < 1e-9 * length; };
  distances.erase(std::unique(distances.begin(), distances.end(), same), distances.end());
  return distances;
}

/// Distances of the nodes from the start, m.
std::vector<double> node_distances(const BeamMeshOptions& options, double length)
{
  std::vector<double> nodes{0.0};
  const auto divide = [&](double to, int n_elements) {
    const double from = nodes.back();
    const int n = options.element_order * n_elements;
    for (int i = 1; i <= n; ++i) nodes.push_back(from + (to - from) * i / n);
  };
  if (options.elements) {
    divide(length, *options.elements);
    return nodes;
  }
  for (const double station : stations(options, length)) {
    const double piece = station - nodes.back();
    divide(station, static_cast<int>(std::ceil(piece / options.element_size.value() - 1e-9)));
  }
  return nodes;
}

/// The node at a point; an equal division is met up to the digits of the distance.
int node_at(const BeamPoint& point, const std::vector<double>& nodes)
{
  const auto nearest = std::ranges::min_element(
      nodes, {}, [&](double distance) { return std::abs(distance - point.distance); });
  const double element = nodes.back() / static_cast<double>(nodes.size() - 1);
  if (std::abs(*nearest - point.distance) > 1e-6 * element) {
    throw Error(
        fmt::format("beam: point \"{}\" at {:.9g} m meets no node, the nearest is at {:.9g} "
                    "m; change `elements`, or give `element_size` instead",
                    point.name, point.distance, *nearest));
  }
  return static_cast<int>(nearest - nodes.begin());
}

void add_nodes(Mesh& mesh, const BeamMeshOptions& options, const std::vector<double>& nodes)
{
  for (const double distance : nodes) {
    const double t = distance / nodes.back();
    std::array<double, 3> x{};
    for (std::size_t c = 0; c < 3; ++c) x[c] = (1.0 - t) * options.start[c] + t * options.end[c];
    mesh.positions.push_back(x);
    mesh.node_numbers.push_back(std::ssize(mesh.positions));
  }
}

void add_elements(Mesh& mesh, int order)
{
  ElementBlock block{.shape = Shape::line,
                     .order = order,
                     .nodes_per_element = order + 1,
                     .numbers = {},
                     .nodes = {},
                     .group = {}};
  for (int first = 0; first + 1 < mesh.n_nodes(); first += order) {
    block.numbers.push_back(std::ssize(block.numbers) + 1);
    block.group.push_back(0);
    for (int i = 0; i <= order; ++i) block.nodes.push_back(first + i);
  }
  mesh.blocks.push_back(std::move(block));
}

}  // namespace

Mesh beam(const BeamMeshOptions& options)
{
  const double length = length_of(options);
  if (!(length > 0.0)) throw Error("beam: start and end are the same point");
  const std::vector<double> nodes = node_distances(options, length);
  Mesh mesh;
  add_nodes(mesh, options, nodes);
  add_elements(mesh, options.element_order);
  Group line{.name = "beam", .dimension = 1, .nodes = std::vector<int>(nodes.size())};
  std::iota(line.nodes.begin(), line.nodes.end(), 0);
  mesh.groups = {line,
                 {.name = "start", .dimension = 0, .nodes = {0}},
                 {.name = "end", .dimension = 0, .nodes = {mesh.n_nodes() - 1}}};
  for (const BeamPoint& point : options.points)
    mesh.groups.push_back({.name = point.name, .dimension = 0, .nodes = {node_at(point, nodes)}});
  return mesh;
}

}  // namespace chladni::mesh
