#include "cli/chladni_steps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "cases/ranks.hpp"
#include "cases/reduce_scene.hpp"
#include "cases/scene_body.hpp"
#include "common/error.hpp"
#include "common/files/output_file.hpp"
#include "mbs_export/files/body_files.hpp"
#include "report/origin.hpp"
#include "report/progress.hpp"
#include "report/version.hpp"

namespace chladni::cli {

void apply_mesh_arguments(const ChladniArguments& arguments, mesh::MeshOptions& options)
{
  if (arguments.trusts_mesh) options.trust = mesh::Trust::owner;
  if (!arguments.mesh_cache.empty()) options.cache = arguments.mesh_cache;
}

scene::Scene read_scene_to_mesh(const ChladniArguments& arguments, scene::Purpose purpose)
{
  scene::Scene scene = scene::read_meshed_scene(arguments.scene.scene, purpose);
  const bool reads_its_reduction =
      scene.response && scene.response->model != mbs_export::ResponseModel::fe;
  if (!scene.has_mesh && !reads_its_reduction)
    scene::refuse_key(scene, "mesh", "is missing: this scene is for `chladni body` alone");
  apply_mesh_arguments(arguments, scene.mesh);
  cases::on_first_rank([&] { tell_notes(scene); });
  return scene;
}

std::filesystem::path reduced_file(const scene::Scene& scene, const SceneArguments& arguments)
{
  return std::filesystem::path(arguments.output) / (scene.name + ".reduced.h5");
}

std::filesystem::path body_file(const scene::Scene& scene, const SceneArguments& arguments)
{
  return std::filesystem::path(arguments.output) / (scene.name + ".body.h5");
}

ReservedOutputs reserve_on_first_rank(const SceneArguments& arguments,
                                      const std::vector<std::filesystem::path>& files)
{
  ReservedOutputs reserved;
  cases::on_first_rank([&] { reserved = reserve_outputs(arguments, files); });
  return reserved;
}

cases::SaidOfSolvers said_of_solvers(const ChladniArguments& arguments)
{
  const char* environment = std::getenv("PETSC_OPTIONS");
  std::vector<std::string> said;
  if (environment != nullptr && *environment != '\0') said.emplace_back(environment);
  said.insert(said.end(), arguments.petsc_options.begin(), arguments.petsc_options.end());
  return {.text = fmt::format("{}", fmt::join(said, " ")), .options = arguments.solver};
}

cases::ReduceProgress progress_bar(std::vector<report::Stage> stages)
{
  if (cases::rank() != 0) return [](const std::string&, double) {};
  struct Bar {
    report::ProgressLine line;
    report::WholeProgress whole;
  };
  const std::shared_ptr<Bar> bar(
      new Bar{.line = {}, .whole = report::WholeProgress(std::move(stages))});
  return [bar](const std::string& phase, double fraction) {
    bar->line.show(phase, bar->whole.at(phase, fraction));
  };
}

cases::ReduceProgress line_of_progress(const scene::Scene& scene)
{
  const auto bar = [&](std::vector<report::Stage> stages) {
    const report::Stage errors{"errors of the mesh", 40.0};
    if (scene.mesh_errors || scene.accuracy) stages.insert(stages.begin(), errors);
    return progress_bar(std::move(stages));
  };
  const cases::ReduceProgress whole = bar(cases::stages_of(scene.reduce)),
                              sectors = bar(cases::stages_of_sectors());
  return [whole, sectors, found = false](const std::string& phase, double fraction) mutable {
    found = found || phase == "modes of harmonics";
    (found ? sectors : whole)(phase, fraction);
  };
}

mbs_export::ReducedSystem read_reduced_of(const scene::Scene& scene,
                                          const SceneArguments& arguments)
{
  const std::filesystem::path file = reduced_file(scene, arguments);
  if (!std::filesystem::exists(file)) {
    throw Error(fmt::format("{}: no such file; make it with `chladni reduce {} --output {}`",
                            file.string(), arguments.scene, arguments.output));
  }
  mbs_export::ReducedSystem reduced = mbs_export::read_reduced(file);
  report::require_of_scene(
      scene, {.file = file, .what = report::Made::reduction, .origin = reduced.provenance},
      stale_of(arguments));
  reduced.provenance.scene_file = scene_file_of(arguments);
  return reduced;
}

mbs_export::ModalBody read_body_of(const scene::Scene& scene, const SceneArguments& arguments)
{
  const std::filesystem::path file = body_file(scene, arguments);
  if (!std::filesystem::exists(file)) {
    throw Error(fmt::format("{}: no such file; make it with `chladni run {} --output {}`",
                            file.string(), arguments.scene, arguments.output));
  }
  mbs_export::ModalBody body = mbs_export::read_body(file);
  report::require_of_scene(scene,
                           {.file = file, .what = report::Made::body, .origin = body.provenance},
                           stale_of(arguments));
  return body;
}

mbs_export::ModalBody make_body_of(const scene::Scene& scene,
                                   const mbs_export::ReducedSystem& reduced)
{
  cases::SceneBody made = cases::scene_body(scene, reduced);
  for (const std::string& note : made.notes) fmt::print(stderr, "note: {}\n", note);
  return std::move(made.body);
}

report::PhaseTime time_of_all_ranks(const report::PhaseTime& time)
{
  return {.name = time.name,
          .wall_s = cases::largest_of_ranks(time.wall_s),
          .cpu_s = cases::sum_over_ranks(time.cpu_s)};
}

report::Cost cost_of_all_ranks(const std::vector<report::PhaseTime>& phases)
{
  report::Cost cost{.phases = {},
                    .wall_s = cases::largest_of_ranks(report::process_wall_s()),
                    .cpu_s = cases::sum_over_ranks(report::process_cpu_s()),
                    .peak_MiB = cases::largest_of_ranks(report::peak_MiB())};
  for (const report::PhaseTime& phase : phases) cost.phases.push_back(time_of_all_ranks(phase));
  return cost;
}

void write_summary(const SceneArguments& arguments,
                   const std::vector<report::Json::Member>& members, const report::Cost& cost)
{
  if (arguments.json.empty()) return;
  std::vector<report::Json::Member> all = {{"program", "chladni"}, {"version", report::version}};
  all.insert(all.end(), members.begin(), members.end());
  for (report::Json::Member& member : report::cost_json(cost)) all.push_back(std::move(member));
  files::write_text(arguments.json, report::Json::object(all).text() + "\n");
}

}  // namespace chladni::cli
