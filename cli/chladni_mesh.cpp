#include <fmt/format.h>

#include <filesystem>

#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "mesh/generators.hpp"
#include "mesh/quality.hpp"
#include "report/fe/mesh_quality.hpp"
#include "scene/names.hpp"

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

report::TextTable mesh_table(const mesh::Mesh& mesh)
{
  report::TextTable table{.header = {"part of the mesh", "count"}, .rows = {}};
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

std::vector<report::Json::Member> mesh_json(const mesh::Mesh& mesh)
{
  int n_elements = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) n_elements += block.n_elements();
  return {{"n_nodes", mesh.n_nodes()},
          {"n_elements", n_elements},
          {"mesh_checksum", mesh::checksum(mesh)},
          {"notes", report::Json::array({mesh.notes.begin(), mesh.notes.end()})}};
}

/// A scene's [mesh], or a mesh file by itself.
struct Subject {
  std::string title;
  mesh::MeshOptions mesh;
};

Subject read_subject(const ChladniArguments& arguments)
{
  const std::string& path = arguments.scene.scene;
  const std::string extension = std::filesystem::path(path).extension().string();
  if (scene::contains({".msh", ".geo", ".step", ".stp"}, extension)) {
    const mesh::Trust trust = arguments.trusts_mesh ? mesh::Trust::owner : mesh::Trust::stranger;
    return {.title = path, .mesh = {.file = path, .trust = trust}};
  }
  const scene::Scene scene = read_scene_to_mesh(arguments, scene::Purpose::fe_model);
  return {.title = scene.title, .mesh = scene.mesh};
}

void mesh_and_print(const ChladniArguments& all)
{
  const SceneArguments& arguments = all.scene;
  const QualityChoice& choice = all.mesh;
  report::PhaseClock clock;
  const Subject subject = read_subject(all);
  const ReservedOutputs reserved = reserve_outputs(arguments, {});
  clock.end_phase("read");
  const mesh::Mesh mesh = choice.quality ? mesh::draft(subject.mesh) : mesh::generate(subject.mesh);
  clock.end_phase("mesh");
  std::vector<report::Json::Member> summary = mesh_json(mesh);
  std::string text;
  if (choice.quality) {
    const std::vector<mesh::ElementQuality> elements = mesh::quality(mesh);
    text = report::quality_text(elements) + "\n";
    for (const report::Json::Member& member : report::quality_json(elements))
      summary.push_back(member);
    clock.end_phase("quality");
  }
  const report::Cost cost = report::cost_so_far(clock.phases());
  fmt::print("{}\n\n{}\n{}{}", report::printable(subject.title),
             report::format_table(mesh_table(mesh)), text,
             report::format_table(report::cost_table(cost)));
  for (const std::string& note : mesh.notes) fmt::print("note: {}\n", note);
  write_summary(arguments, summary, cost);
  if (choice.quality) mesh::check_usable(mesh, arguments.scene);
}

}  // namespace

void mesh_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { mesh_and_print(arguments); });
}

}  // namespace chladni::cli
