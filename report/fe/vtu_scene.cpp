#include "report/fe/vtu_scene.hpp"

#include <algorithm>
#include <map>

#include "common/eigen_every.hpp"
#include "mesh/element_parts.hpp"
#include "plate/sections/profile.hpp"
#include "plate/sections/sections.hpp"

namespace chladni::report {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// One point for each node of each group.
class Points {
 public:
  int point(int node, int group)
  {
    const auto [it, is_new] =
        index_.emplace(std::pair(node, group), static_cast<int>(nodes.size()));
    if (is_new) {
      nodes.push_back(node);
      groups.push_back(group);
    }
    return it->second;
  }
  std::vector<int> nodes, groups;

 private:
  std::map<std::pair<int, int>, int> index_;
};

void add_cell(VtuGrid& grid, Points& points, const mesh::ElementBlock& block, int element)
{
  const std::span<const int> nodes = block.element_nodes(element);
  for (const int place : mesh::corners_first(block.shape, block.order))
    grid.connectivity.push_back(points.point(nodes[place], block.group[element]));
  grid.offsets.push_back(static_cast<int>(grid.connectivity.size()));
  grid.types.push_back(vtu_cell_type(block.shape, block.order));
}

/// Number, group and rank of each element. Nodes inside an element belong to its rank, those on its
/// edges to a lower one perhaps.
void add_cell_fields(VtuGrid& grid, const mesh::Mesh& mesh, std::span<const int> owners)
{
  const auto n = static_cast<Index>(grid.types.size());
  VtuField number{.name = "element", .values = MatrixXd(n, 1)};
  VtuField group{.name = "group", .values = MatrixXd(n, 1)};
  VtuField rank{.name = "partition", .values = MatrixXd(n, 1)};
  Index cell = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e, ++cell) {
      int highest = 0;
      for (const int node : block.element_nodes(e)) highest = std::max(highest, owners[node]);
      number.values(cell) = static_cast<double>(block.numbers[e]);
      group.values(cell) = block.group[e];
      rank.values(cell) = highest;
    }
  }
  grid.of_cells = {std::move(number), std::move(group), std::move(rank)};
}

/// At the points of shells; 0 elsewhere.
VtuField thickness(const mesh::Mesh& mesh, std::span<const plate::ShellSection> sections,
                   const Points& points)
{
  const std::vector<int> of_group = plate::section_of_group(mesh, sections);
  VtuField field{.name = "thickness",
                 .values = MatrixXd::Zero(static_cast<Index>(points.nodes.size()), 1)};
  for (std::size_t i = 0; i < points.nodes.size(); ++i) {
    const int group = points.groups[i];
    const int section = group < 0 ? -1 : of_group[group];
    if (section < 0) continue;
    field.values(static_cast<Index>(i)) =
        plate::value_at(sections[section].thickness, mesh.positions[points.nodes[i]]);
  }
  return field;
}

}  // namespace

SceneGrid scene_grid(const mesh::Mesh& mesh, std::span<const plate::ShellSection> sections,
                     std::span<const int> owners)
{
  SceneGrid result;
  Points points;
  for (const mesh::ElementBlock& block : mesh.blocks)
    for (int e = 0; e < block.n_elements(); ++e) add_cell(result.grid, points, block, e);
  result.grid.points.resize(static_cast<Index>(points.nodes.size()), 3);
  for (std::size_t i = 0; i < points.nodes.size(); ++i) {
    const auto& x = mesh.positions[points.nodes[i]];
    result.grid.points.row(static_cast<Index>(i)) << x[0], x[1], x[2];
  }
  result.grid.of_points.push_back(thickness(mesh, sections, points));
  add_cell_fields(result.grid, mesh, owners);
  result.node_of_point = std::move(points.nodes);
  result.group_of_point = std::move(points.groups);
  return result;
}

void add_motions(SceneGrid& scene_grid, const Eigen::MatrixXd& motions, const std::string& prefix)
{
  const MatrixXd of_points = motions(scene_grid.node_of_point, every);
  auto& fields = scene_grid.grid.of_points;
  fields.push_back({.name = prefix + "displacement", .values = of_points.leftCols<3>()});
  fields.push_back({.name = prefix + "rotation", .values = of_points.rightCols<3>()});
}

void add_resultants(SceneGrid& scene_grid, const mesh::Mesh& mesh,
                    std::span<const plate::ShellSection> sections,
                    std::span<const plate::ShellResultants> resultants)
{
  const std::vector<int> of_group = plate::section_of_group(mesh, sections);
  const auto n = static_cast<Index>(scene_grid.node_of_point.size());
  VtuField N{.name = "membrane_force", .values = MatrixXd::Zero(n, 6)};
  VtuField M{.name = "moment", .values = MatrixXd::Zero(n, 6)};
  VtuField Q{.name = "shear_force", .values = MatrixXd::Zero(n, 3)};
  for (Index i = 0; i < n; ++i) {
    const int group = scene_grid.group_of_point[static_cast<std::size_t>(i)];
    const int node = scene_grid.node_of_point[static_cast<std::size_t>(i)];
    if (group < 0 || of_group[group] < 0) continue;
    const plate::ShellResultants& section = resultants[of_group[group]];
    N.values.row(i) = section.N.row(node);
    M.values.row(i) = section.M.row(node);
    Q.values.row(i) = section.Q.row(node);
  }
  for (VtuField* field : {&N, &M, &Q}) scene_grid.grid.of_points.push_back(std::move(*field));
}

}  // namespace chladni::report
