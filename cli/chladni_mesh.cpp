#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cases/chosen_mesh.hpp"
#include "cases/mesh_scene.hpp"
#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "cli/writer_mark.hpp"
#include "common/error.hpp"
#include "files/text_file.hpp"
#include "mesh/generators.hpp"
#include "mesh/quality.hpp"
#include "mesh/repetition.hpp"
#include "report/fe/mesh_groups.hpp"
#include "report/fe/mesh_page.hpp"
#include "report/fe/mesh_quality.hpp"
#include "report/fe/mesh_table.hpp"
#include "report/fe/mesh_vtu.hpp"
#include "report/output.hpp"
#include "scene/names.hpp"

namespace chladni::cli {
namespace {

/// A scene, or a mesh file by itself, whose title is then its path.
struct Subject {
  std::string name;  ///< stem of the files that are written
  std::string title;
  mesh::MeshOptions mesh;
  std::optional<scene::Scene> scene = {};
};

Subject read_subject(const ChladniArguments& arguments)
{
  const std::string& path = arguments.scene.scene;
  const std::string& unit = arguments.mesh.length_unit;
  const bool has_no_unit = mesh::is_deck(path) || mesh::is_exchange(path);
  if (has_no_unit && unit.empty()) {
    throw Error(path +
                ": this kind of file states no unit of length; give it, e.g. --length-unit mm");
  }
  if (!has_no_unit && !unit.empty()) {
    throw Error(path +
                ": --length-unit is for decks, .unv, .med and .vtu files without a scene; give "
                "length_unit in [mesh] instead");
  }
  if (mesh::mesh_source(path)) {
    Subject subject{.name = std::filesystem::path(path).stem().string(),
                    .title = path,
                    .mesh = {.file = path, .length_unit = has_no_unit ? metres_of(unit) : 1.0}};
    apply_mesh_arguments(arguments, subject.mesh);
    return subject;
  }
  const scene::Scene scene = read_scene_to_mesh(arguments, scene::Purpose::fe_model);
  return {.name = scene.name, .title = scene.title, .mesh = scene.mesh, .scene = scene};
}

/// The files with the picture.
struct PictureFiles {
  std::filesystem::path vtu, page;
};

PictureFiles picture_files(const Subject& subject, const SceneArguments& arguments)
{
  const std::filesystem::path folder(arguments.output);
  return {.vtu = folder / (subject.name + ".mesh.vtu"),
          .page = folder / (subject.name + ".mesh.html")};
}

void write_picture(const PictureFiles& files, const Subject& subject, const mesh::Mesh& mesh,
                   const SceneArguments& arguments)
{
  const std::vector<report::GroupParts> parts = report::group_parts(mesh);
  const std::string mark = writer_mark(arguments);
  files::write_text(files.vtu, report::mesh_vtu(mesh, parts) + mark);
  files::write_text(files.page,
                    report::mesh_page(subject.title, mesh, parts, report::mesh_table(mesh)) + mark);
}

/// A body that repeats costs less than it seems.
void tell_of_sectors(const Subject& subject, const mesh::Mesh& mesh)
{
  if (subject.mesh.sector_search == mesh::SectorSearch::asked || mesh.sectors.count > 1) return;
  const int count = mesh::n_repetitions(mesh);
  if (count < 3) return;
  fmt::print(
      "note: the body repeats {} times about the z axis: mesh.sectors = \"auto\" reduces it from "
      "one sector, at a fraction of the cost\n",
      count);
}

/// On the first rank.
void mesh_and_print(const ChladniArguments& all, const Subject& subject)
{
  const SceneArguments& arguments = all.scene;
  const QualityChoice& choice = all.mesh;
  report::PhaseClock clock;
  const PictureFiles files = picture_files(subject, arguments);
  const ReservedOutputs reserved = reserve_outputs(arguments, {files.vtu, files.page});
  const mesh::Mesh mesh = choice.quality ? mesh::draft(subject.mesh) : mesh::generate(subject.mesh);
  clock.end_phase("mesh");
  std::vector<report::Json::Member> summary = report::mesh_json(mesh);
  std::string text;
  if (choice.quality) {
    const std::vector<mesh::ElementQuality> elements = mesh::quality(mesh);
    text = report::quality_text(elements) + "\n";
    for (const report::Json::Member& member : report::quality_json(elements))
      summary.push_back(member);
    clock.end_phase("quality");
  }
  write_picture(files, subject, mesh, arguments);
  clock.end_phase("picture");
  const report::Cost cost = report::cost_so_far(clock.phases());
  fmt::print("{}\n\n{}\n{}{}", report::printable(subject.title),
             report::format_table(report::mesh_table(mesh)), text,
             report::format_table(report::cost_table(cost)));
  for (const std::string& note : mesh.notes) fmt::print("note: {}\n", report::printable(note));
  tell_of_sectors(subject, mesh);
  write_summary(arguments, summary, cost);
  fmt::print("\nwrote {}\nwrote {}\n", files.vtu.string(), files.page.string());
  if (choice.quality) mesh::check_usable(mesh, arguments.scene);
  if (subject.scene) cases::check_groups(*subject.scene, mesh);  // now they can be looked up
}

}  // namespace

void mesh_command(const ChladniArguments& arguments)
{
  Subject subject = read_subject(arguments);
  if (subject.scene && subject.scene->accuracy) {
    const cases::ReduceProgress bar = progress_bar({{"errors of the mesh", 100.0}});
    cases::Phases phases(bar);
    subject.mesh = cases::chosen_mesh(*subject.scene, cases::supports_of(*subject.scene),
                                      arguments.solver, phases)
                       .scene.mesh;
  }
  cases::on_first_rank([&] { mesh_and_print(arguments, subject); });
}

}  // namespace chladni::cli
