#include "report/fe/mesh_table.hpp"

#include <fmt/format.h>

#include <string>

namespace chladni::report {
namespace {

std::string name_of(mesh::Shape shape)
{
  switch (shape) {
    case mesh::Shape::line:
      return "lines";
    case mesh::Shape::triangle:
      return "triangles";
    case mesh::Shape::quadrilateral:
      return "quadrilaterals";
  }
  return "";
}

}  // namespace

TextTable mesh_table(const mesh::Mesh& mesh)
{
  TextTable table{.header = {"part of the mesh", "count"}, .rows = {}};
  table.rows.push_back({"nodes", fmt::format("{}", mesh.n_nodes())});
  for (const mesh::ElementBlock& block : mesh.blocks) {
    table.rows.push_back({fmt::format("{} of order {}", name_of(block.shape), block.order),
                          fmt::format("{}", block.n_elements())});
  }
  for (const mesh::Group& group : mesh.groups) {
    table.rows.push_back(
        {fmt::format("nodes of {}", group.name), fmt::format("{}", group.nodes.size())});
  }
  return table;
}

std::vector<Json::Member> mesh_json(const mesh::Mesh& mesh)
{
  int n_elements = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) n_elements += block.n_elements();
  return {{"n_nodes", mesh.n_nodes()},
          {"n_elements", n_elements},
          {"mesh_checksum", mesh::checksum(mesh)},
          {"notes", Json::array({mesh.notes.begin(), mesh.notes.end()})}};
}

}  // namespace chladni::report
