#include "report/fe/mesh_vtu.hpp"

#include <cstdint>
#include <utility>

#include "mesh/element_parts.hpp"
#include "report/fe/vtu.hpp"

namespace chladni::report {
namespace {

using Eigen::Index;

constexpr std::size_t most_marks = 30'000'000;  ///< bytes, of all groups together

struct Cells {
  VtuGrid grid;
  std::vector<std::int64_t> element, group;
};

void add_cell(Cells& cells, int type, int group, std::int64_t element)
{
  cells.grid.offsets.push_back(static_cast<int>(cells.grid.connectivity.size()));
  cells.grid.types.push_back(type);
  cells.group.push_back(group);
  cells.element.push_back(element);
}

void add_elements(Cells& cells, const mesh::ElementBlock& block)
{
  const std::vector<int> order = mesh::corners_first(block.shape, block.order);
  for (int e = 0; e < block.n_elements(); ++e) {
    for (const int place : order) cells.grid.connectivity.push_back(block.element_nodes(e)[place]);
    add_cell(cells, vtu_cell_type(block.shape, block.order), block.group[e], block.numbers[e]);
  }
}

void add_edge(Cells& cells, const std::vector<int>& edge, int group)
{
  const auto order = static_cast<int>(edge.size()) - 1;
  for (const int place : mesh::corners_first(mesh::Shape::line, order))
    cells.grid.connectivity.push_back(edge[place]);
  add_cell(cells, vtu_cell_type(mesh::Shape::line, order), group, 0);
}

/// What elements alone do not show of a group.
void add_parts(Cells& cells, const GroupParts& parts, int group)
{
  if (parts.kind == GroupKind::curve)
    for (const std::vector<int>& edge : parts.edges) add_edge(cells, edge, group);
  for (const int node : parts.points) {
    cells.grid.connectivity.push_back(node);
    add_cell(cells, vtu_vertex, group, 0);
  }
}

VtuField column(const std::string& name, const std::vector<std::int64_t>& values)
{
  VtuField field{.name = name, .values = Eigen::MatrixXd(std::ssize(values), 1)};
  for (Index i = 0; i < std::ssize(values); ++i)
    field.values(i) = static_cast<double>(values[static_cast<std::size_t>(i)]);
  return field;
}

VtuMarks marks_of_group(const mesh::Mesh& mesh, const Cells& cells, std::size_t group)
{
  VtuMarks marks{.name = "group " + mesh.groups[group].name, .values = {}};
  for (const std::int64_t of_cell : cells.group)
    marks.values.push_back(std::cmp_equal(of_cell, group) ? 1 : 0);
  return marks;
}

}  // namespace

std::string mesh_vtu(const mesh::Mesh& mesh, const std::vector<GroupParts>& parts)
{
  Cells cells;
  for (const mesh::ElementBlock& block : mesh.blocks) add_elements(cells, block);
  for (std::size_t g = 0; g < parts.size(); ++g) add_parts(cells, parts[g], static_cast<int>(g));
  cells.grid.points.resize(mesh.n_nodes(), 3);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const auto& [x, y, z] = mesh.positions[i];
    cells.grid.points.row(i) << x, y, z;
  }
  cells.grid.of_points = {column("node", mesh.node_numbers)};
  cells.grid.of_cells = {column("element", cells.element), column("group", cells.group)};
  if (cells.group.size() * mesh.groups.size() <= most_marks)
    for (std::size_t g = 0; g < mesh.groups.size(); ++g)
      cells.grid.marks_of_cells.push_back(marks_of_group(mesh, cells, g));
  return vtu_text(cells.grid);
}

}  // namespace chladni::report
