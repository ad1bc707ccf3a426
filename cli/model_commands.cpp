#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cases/chosen_mesh.hpp"
#include "cases/fe_responses.hpp"
#include "cases/fe_solution.hpp"
#include "cases/ranks.hpp"
#include "cases/scene_body.hpp"
#include "cases/scene_mesh.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "common/error.hpp"
#include "common/files/output_file.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mbs_export/measured/measured_functions.hpp"
#include "mbs_export/responses/response_files.hpp"
#include "mesh/generators.hpp"
#include "mesh/quality.hpp"
#include "mesh/sectors.hpp"
#include "report/describe_responses.hpp"
#include "report/fe/mesh_report.hpp"
#include "report/fe/vtu.hpp"
#include "report/page/pages.hpp"
#include "report/progress.hpp"
#include "report/text_table.hpp"
#include "scene/keys.hpp"

namespace chladni::cli {

using std::filesystem::path;

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
                ": --length-unit is for decks, .unv and .med files without a scene; give "
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
  if (!subject.scene) return;
  cases::check_groups(*subject.scene, mesh);  // now they can be looked up
  if (const auto note = cases::note_of_overlap(*subject.scene, mesh)) report::tell_note(*note);
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

namespace {

void check_loads(const scene::Scene& scene)
{
  if (!scene.loads.empty()) return;
  throw Error(fmt::format("{}: load is missing: `chladni static` needs a [[load]]", scene.path));
}

}  // namespace

void static_command(const ChladniArguments& arguments)
{
  const scene::Scene scene = read_scene_to_mesh(arguments, scene::Purpose::fe_model);
  check_loads(scene);
  const std::filesystem::path file =
      std::filesystem::path(arguments.scene.output) / (scene.name + ".static.vtu");
  const ReservedOutputs reserved = reserve_on_first_rank(arguments.scene, {file});
  cases::ReduceProgress bar =
      progress_bar({{"mesh", 10.0}, {"assembly", 20.0}, {"solution", 70.0}});
  cases::Phases phases(bar);
  const cases::SupportedModel model = cases::supported_model(scene, arguments.solver, phases);
  phases.begin("solution");
  const cases::StaticFields found = cases::static_fields(scene, model, arguments.solver);
  phases.end();
  bar = {};
  const report::Cost cost = cost_of_all_ranks(phases.times());
  cases::on_first_rank([&] {
    const report::TextTable reported = cases::reported_table(scene, model, found);
    files::write_text(file, report::vtu_text(cases::static_picture(scene, model, found)) +
                                writer_mark(arguments.scene));
    fmt::print("{}\n\n{}\n{}{}{}\n{}\nwrote {}\n", report::printable(scene.title),
               report::format_table(cases::static_table(found)),
               reported.rows.empty() ? "" : report::format_table(reported),
               reported.rows.empty() ? "" : "\n", report::format_table(cases::model_table(model)),
               report::format_table(report::cost_table(cost)), file.string());
    write_summary(arguments.scene, cases::static_json(scene, model, found), cost);
  });
}

void modes_command(const ChladniArguments& arguments)
{
  const scene::Scene scene = read_scene_to_mesh(arguments, scene::Purpose::fe_model);
  const std::filesystem::path file =
      std::filesystem::path(arguments.scene.output) / (scene.name + ".modes.vtu");
  const ReservedOutputs reserved = reserve_on_first_rank(arguments.scene, {file});
  cases::ReduceProgress bar = progress_bar({{"mesh", 10.0}, {"assembly", 20.0}, {"modes", 70.0}});
  cases::Phases phases(bar);
  const cases::SupportedModel model = cases::supported_model(scene, arguments.solver, phases);
  const cases::SceneModes found = cases::scene_modes(scene, model, arguments.solver, phases);
  const report::SceneGrid grid = cases::mode_grid(scene, model, found.modes);
  bar = {};
  const report::Cost cost = cost_of_all_ranks(phases.times());
  cases::on_first_rank([&] {
    files::write_text(file, report::vtu_text(grid.grid) + writer_mark(arguments.scene));
    fmt::print("{}\n\n{}\n{}\n{}\nwrote {}\n", report::printable(scene.title),
               report::format_table(cases::mode_table(found)),
               report::format_table(cases::model_table(model)),
               report::format_table(report::cost_table(cost)), file.string());
    write_summary(arguments.scene, cases::modes_json(model, found), cost);
  });
}

namespace {

/// What the command writes.
struct ModelFiles {
  path values, table, page, universal;  ///< the last one only if it is asked for

  std::vector<path> all() const
  {
    std::vector<path> files{values, table, page};
    if (!universal.empty()) files.push_back(universal);
    return files;
  }
};

ModelFiles model_files(const scene::Scene& scene, const ChladniArguments& arguments)
{
  const auto file = [&](const char* kind) {
    return path(arguments.scene.output) / (scene.name + kind);
  };
  return {.values = file(".response.h5"),
          .table = file(".response.csv"),
          .page = file(".response.html"),
          .universal = arguments.response.universal_file};
}

/// What a measurement left out.
void tell_left_out(const scene::Scene& scene, const mbs_export::FrequencyResponses& responses)
{
  if (!scene.response->measurement) return;
  const mbs_export::MeasuredFunctions& measured = *scene.response->measurement->functions;
  const std::size_t n = measured.functions.size(), n_used = responses.measured.functions.size();
  std::vector<std::string> notes = measured.notes;
  if (n_used < n) {
    notes.push_back(
        fmt::format("{}: {} of {} frequency responses are between other nodes or "
                    "directions than those of [response]",
                    measured.file, n - n_used, n));
  }
  for (const std::string& note : notes) report::tell_note(report::printable(note));
}

void write_and_print(const ChladniArguments& arguments, const ModelFiles& files,
                     const mbs_export::FrequencyResponses& responses, const report::Cost& cost)
{
  const std::string universal =  // before anything is written: not all can be said in one
      files.universal.empty() ? std::string() : universal_file_of(responses);
  mbs_export::write_responses(files.values, responses);
  files::write_text(files.table.string(), csv_of(responses));
  files::write_text(files.page.string(),
                    report::responses_page(responses) + writer_mark(arguments.scene));
  if (!files.universal.empty()) files::write_text(files.universal.string(), universal);
  fmt::print("{}\n\n{}\n{}\n{}\n", report::printable(responses.title),
             report::format_table(report::describe(responses)),
             report::format_table(report::list_peaks(responses)),
             report::format_table(report::cost_table(cost)));
  if (!responses.measured.functions.empty()) {
    fmt::print("beside {}\n{}\n", report::printable(responses.measured.file),
               report::format_table(report::list_measured(responses)));
  }
  for (const path& file : files.all()) fmt::print("wrote {}\n", file.string());
  write_summary(arguments.scene, report::responses_json(responses), cost);
}

/// The measured responses in the range of the scene.
mbs_export::Measurement measurement_of(const ResponseChoice& choice,
                                       const mbs_export::FrequencyRange& range)
{
  std::optional<double> metres, distance;
  if (!choice.length_unit.empty()) metres = metres_of(choice.length_unit);
  if (choice.distance > 0.0) distance = choice.distance;
  const mbs_export::MeasuredFunctions all =
      mbs_export::read_measured_functions(choice.measured, metres);
  return {.functions = std::make_shared<const mbs_export::MeasuredFunctions>(
              mbs_export::within(all, range.from_Hz, range.to_Hz)),
          .distance = distance};
}

mbs_export::FrequencyResponses of_reduction(const scene::Scene& scene,
                                            const SceneArguments& arguments)
{
  if (scene.response->model == mbs_export::ResponseModel::reduced)
    return cases::reduced_responses(scene, read_reduced_of(scene, arguments));
  return cases::body_responses(scene, read_body_of(scene, arguments));
}

/// Of the body or of the reduced system, on the first rank.
void respond_reduced(const ChladniArguments& arguments, const scene::Scene& scene)
{
  report::PhaseClock clock;
  const ModelFiles files = model_files(scene, arguments);
  const ReservedOutputs reserved = reserve_outputs(arguments.scene, files.all());
  mbs_export::FrequencyResponses responses = of_reduction(scene, arguments.scene);
  responses.provenance.scene_file = scene_file_of(arguments.scene);
  tell_left_out(scene, responses);
  clock.end_phase("responses");
  write_and_print(arguments, files, responses, report::cost_so_far(clock.phases()));
}

/// Of the FE model, on all ranks.
void respond_fe(const ChladniArguments& arguments, const scene::Scene& asked)
{
  const scene::Scene scene = cases::held_as_body(asked);
  const ModelFiles files = model_files(scene, arguments);
  const ReservedOutputs reserved = reserve_on_first_rank(arguments.scene, files.all());
  cases::ReduceProgress bar =
      progress_bar({{"mesh", 5.0}, {"assembly", 5.0}, {"frequencies", 90.0}});
  cases::Phases phases(bar);
  const cases::SupportedModel model = cases::supported_model(scene, arguments.solver, phases);
  mbs_export::FrequencyResponses responses =
      cases::fe_responses(scene, model, arguments.solver, phases);
  bar = {};
  const report::Cost cost = cost_of_all_ranks(phases.times());
  cases::on_first_rank([&] {
    responses.provenance = cases::provenance(scene, said_of_solvers(arguments), model.mesh);
    responses.provenance.scene_file = scene_file_of(arguments.scene);
    tell_left_out(scene, responses);
    write_and_print(arguments, files, responses, cost);
  });
}

}  // namespace

void response_command(const ChladniArguments& arguments)
{
  scene::Scene scene = read_scene_to_mesh(arguments, scene::Purpose::fe_model);
  if (!scene.response) {
    throw Error(
        fmt::format("{}: response is missing: `chladni response` needs a [response] with "
                    "loads, outputs, from_Hz, to_Hz and count",
                    scene.path));
  }
  if (!arguments.response.measured.empty())
    scene.response->measurement = measurement_of(arguments.response, scene.response->range);
  if (scene.response->model == mbs_export::ResponseModel::fe) return respond_fe(arguments, scene);
  cases::on_first_rank([&] { respond_reduced(arguments, scene); });
}

void declare_length_unit(CLI::App& app, std::string& unit)
{
  app.add_option("--length-unit", unit, "unit of length of a deck, .unv or .med file")
      ->type_name("UNIT")
      ->check(CLI::IsMember({"m", "cm", "mm", "inch"}));
}

void declare_mac(CLI::App& app, MacArguments& arguments)
{
  CLI::App* mac = app.add_subcommand("mac", "compares measured mode shapes with those of a body");
  mac->add_option("BODY", arguments.body, "*.body.h5")->required();
  mac->add_option("MEASURED", arguments.measured,
                  "universal file with modes (55) and nodes (15, 2411)")
      ->required();
  mac->add_option("--distance", arguments.distance,
                  "largest distance from a measured node to its node of the body, m")
      ->type_name("METRES")
      ->check(CLI::PositiveNumber)
      ->required();
  declare_length_unit(*mac, arguments.length_unit);
  mac->add_option("--json", arguments.json, "writes the MAC matrix as JSON")->type_name("FILE");
  mac->footer(
      "Example:\n  chladni mac out/disc.body.h5 modes.unv --distance 0.002 --json mac.json");
}

void declare_response(CLI::App& response, ResponseChoice& choice)
{
  response
      .add_option("--uff", choice.universal_file,
                  "also writes the responses to a universal file (datasets 58, 2411, 164)")
      ->type_name("FILE");
  CLI::Option* const measured =
      response
          .add_option("--measured", choice.measured,
                      "compares with the frequency responses of a universal file (dataset 58), at "
                      "its frequencies from from_Hz to to_Hz")
          ->type_name("FILE");
  response
      .add_option("--distance", choice.distance,
                  "largest distance from a measured node to a load or output, m")
      ->type_name("METRES")
      ->check(CLI::PositiveNumber)
      ->needs(measured);
  declare_length_unit(response, choice.length_unit);
  response.get_option("--length-unit")->needs(measured);
}

}  // namespace chladni::cli
