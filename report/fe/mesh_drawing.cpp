#include "report/fe/mesh_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "mesh/element_parts.hpp"

namespace chladni::report {
namespace {

using Place = std::int32_t;

/// How far one goes along the lattice of an element from one drawn node to the next.
int step_of(Detail detail, int order)
{
  return detail == Detail::lattice ? 1 : order;
}

std::size_t n_cells(const mesh::Mesh& mesh, Detail detail)
{
  std::size_t n = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    n += mesh::lattice_cells(block, step_of(detail, block.order)).size() *
         static_cast<std::size_t>(block.n_elements());
  }
  return n;
}

/// The node that is drawn in place of each node: the first one in its cube of the grid.
std::vector<int> clusters(const mesh::Mesh& mesh, double width)
{
  std::map<std::array<std::int64_t, 3>, int> first;
  std::vector<int> drawn(mesh.positions.size());
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    std::array<std::int64_t, 3> cube{};
    for (std::size_t c = 0; c < 3; ++c) cube[c] = std::llround(mesh.positions[i][c] / width);
    drawn[i] = first.emplace(cube, i).first->second;
  }
  return drawn;
}

/// Draws with some nodes in place of others.
class Drawer {
 public:
  Drawer(const mesh::Mesh& mesh, Detail detail, std::vector<int> drawn)
      : mesh_(mesh), drawn_(std::move(drawn)), place_(mesh.positions.size(), -1)
  {
    drawing_.detail = detail;
  }
  void add_cells();
  void add_edges();
  void add_group(const GroupParts& parts);
  MeshDrawing drawing() && { return std::move(drawing_); }

 private:
  Place place(int node);
  void add_cell(std::array<Place, 4> corners, int group, mesh::Shape shape);
  std::vector<Place> along(const std::vector<int>& edge);

  const mesh::Mesh& mesh_;
  std::vector<int> drawn_;
  std::vector<Place> place_;
  std::set<std::vector<Place>> seen_;
  MeshDrawing drawing_;
};

Place Drawer::place(int node)
{
  Place& place = place_[drawn_[node]];
  if (place < 0) {
    place = static_cast<Place>(drawing_.positions.size() / 3);
    for (const double x : mesh_.positions[drawn_[node]])
      drawing_.positions.push_back(static_cast<float>(x));
  }
  return place;
}

/// Clusters shrink some cells to triangles, lines and points, and make some equal to others: what
/// is no longer a surface, or is there already, is left out.
void Drawer::add_cell(std::array<Place, 4> corners, int group, mesh::Shape shape)
{
  if (drawing_.detail == Detail::clusters) {
    std::vector<Place> round;
    for (const Place corner : corners)
      if (round.empty() || (round.back() != corner && round.front() != corner))
        round.push_back(corner);
    if (round.size() < (shape == mesh::Shape::line ? 2U : 3U)) return;
    round.resize(4, round.back());
    std::ranges::copy(round, corners.begin());
    std::ranges::sort(round);
    if (!seen_.insert(round).second) return;
  }
  drawing_.cells.insert(drawing_.cells.end(), corners.begin(), corners.end());
  drawing_.group_of_cell.push_back(group);
}

void Drawer::add_cells()
{
  for (const mesh::ElementBlock& block : mesh_.blocks) {
    const std::vector<mesh::LatticeCell> cells =
        mesh::lattice_cells(block, step_of(drawing_.detail, block.order));
    for (int e = 0; e < block.n_elements(); ++e) {
      for (mesh::LatticeCell cell : cells) {
        for (int& corner : cell) corner = place(block.element_nodes(e)[corner]);
        add_cell(cell, block.group[e], block.shape);
      }
    }
  }
}

/// The drawn nodes of an edge.
std::vector<Place> Drawer::along(const std::vector<int>& edge)
{
  const auto order = static_cast<int>(edge.size()) - 1;
  std::vector<Place> places;
  for (int i = 0; i <= order; i += step_of(drawing_.detail, order))
    places.push_back(place(edge[i]));
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

void Drawer::add_edges()
{
  if (drawing_.detail == Detail::clusters) return;
  std::set<std::pair<Place, Place>> seen;
  for (const mesh::ElementBlock& block : mesh_.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      for (const std::vector<int>& edge : mesh::edges_of(block, e)) {
        const std::vector<Place> places = along(edge);
        if (!seen.insert(std::minmax(places.front(), places.back())).second) continue;
        for (std::size_t i = 1; i < places.size(); ++i)
          drawing_.edges.insert(drawing_.edges.end(), {places[i - 1], places[i]});
      }
    }
  }
}

void Drawer::add_group(const GroupParts& parts)
{
  GroupDrawing group;
  for (const std::vector<int>& edge : parts.edges) {
    const std::vector<Place> places = along(edge);
    for (std::size_t i = 1; i < places.size(); ++i)
      group.lines.insert(group.lines.end(), {places[i - 1], places[i]});
  }
  std::set<Place> points;
  for (const int node : parts.points) points.insert(place(node));
  group.points.assign(points.begin(), points.end());
  drawing_.groups.push_back(std::move(group));
}

MeshDrawing drawn(const mesh::Mesh& mesh, std::span<const GroupParts> parts, Detail detail,
                  std::vector<int> nodes)
{
  Drawer drawer(mesh, detail, std::move(nodes));
  drawer.add_cells();
  drawer.add_edges();
  for (const GroupParts& group : parts) drawer.add_group(group);
  return std::move(drawer).drawing();
}

double width_of(const mesh::Mesh& mesh)
{
  double width = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto [least, greatest] =
        std::ranges::minmax_element(mesh.positions, {}, [&](const auto& x) { return x[c]; });
    width = std::max(width, (*greatest)[c] - (*least)[c]);
  }
  return width;
}

}  // namespace

MeshDrawing draw_mesh(const mesh::Mesh& mesh, std::span<const GroupParts> parts,
                      const DrawingLimits& limits)
{
  std::vector<int> own(mesh.positions.size());
  for (int i = 0; i < mesh.n_nodes(); ++i) own[i] = i;
  const std::size_t n_lattice = n_cells(mesh, Detail::lattice);
  const std::size_t n_corners = n_cells(mesh, Detail::corners);
  const bool is_linear = n_lattice == n_corners;
  if (n_lattice <= (is_linear ? limits.corners : limits.lattice))
    return drawn(mesh, parts, Detail::lattice, std::move(own));
  if (n_corners <= limits.corners) return drawn(mesh, parts, Detail::corners, std::move(own));
  double cube = width_of(mesh) / std::sqrt(static_cast<double>(limits.corners));
  MeshDrawing drawing = drawn(mesh, parts, Detail::clusters, clusters(mesh, cube));
  while (drawing.group_of_cell.size() > limits.corners) {
    cube *= 1.3;
    drawing = drawn(mesh, parts, Detail::clusters, clusters(mesh, cube));
  }
  return drawing;
}

}  // namespace chladni::report
