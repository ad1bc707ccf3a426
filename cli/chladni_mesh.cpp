#include <fmt/format.h>

#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "cli/mesh_scene.hpp"
#include "cli/petsc_session.hpp"

namespace chladni::cli {
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
          {"mesh_checksum", mesh::checksum(mesh)}};
}

void mesh_and_print(const SceneArguments& arguments)
{
  PhaseClock clock;
  const Scene scene = read_meshed_scene(arguments.scene);
  clock.end_phase("read");
  const mesh::Mesh mesh = mesh_scene(scene);
  clock.end_phase("mesh");
  const Cost cost = cost_so_far(clock.phases());
  fmt::print("{}\n\n{}\n{}", scene.title, format_table(mesh_table(mesh)),
             format_table(cost_table(cost)));
  write_summary(arguments, mesh_json(mesh), cost);
}

}  // namespace

void mesh_command(const ChladniArguments& arguments)
{
  on_first_rank([&] { mesh_and_print(arguments.scene); });
}

}  // namespace chladni::cli
