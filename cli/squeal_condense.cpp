#include "cli/squeal_condense.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <utility>
#include <vector>

#include "cases/squeal/condense.hpp"
#include "cli/reserve_outputs.hpp"
#include "files/text_file.hpp"
#include "report/cost.hpp"
#include "report/json.hpp"
#include "report/output.hpp"
#include "report/timing.hpp"
#include "report/version.hpp"
#include "scene/scene.hpp"

namespace chladni::cli {
namespace {

/// "brake.condensed/pad.body.h5", as a scene names it.
std::string relative_name(const std::filesystem::path& file)
{
  return (file.parent_path().filename() / file.filename()).generic_string();
}

report::TextTable table_of(const cases::CondensedBrake& brake)
{
  report::TextTable table{.header = {"part", "body", "coordinates before", "after"}, .rows = {}};
  Eigen::Index before = 0, after = 0;
  for (const cases::CondensedPart& part : brake.parts) {
    table.rows.push_back({part.name, report::printable(relative_name(part.file)),
                          fmt::format("{}", part.before), fmt::format("{}", part.after)});
    before += part.before;
    after += part.after;
  }
  table.rows.push_back({"all", "", fmt::format("{}", before), fmt::format("{}", after)});
  return table;
}

void write_json(const std::string& file, const cases::CondensedBrake& brake,
                const report::Cost& cost)
{
  std::vector<report::Json> parts;
  for (const cases::CondensedPart& part : brake.parts) {
    parts.push_back(report::Json::object({{"part", part.name},
                                          {"file", part.file.string()},
                                          {"coordinates_before", int(part.before)},
                                          {"coordinates", int(part.after)}}));
  }
  const squeal::CondensationError& error = brake.found.error;
  std::vector<report::Json::Member> members = {{"program", "squeal"},
                                               {"version", report::version},
                                               {"parts", report::Json::array(parts)},
                                               {"error", error.eigenvalues},
                                               {"growth_error_1_s", error.growth},
                                               {"eigenvalues", error.n_eigenvalues},
                                               {"states", error.n_states},
                                               {"unstable_beyond", error.n_unstable_beyond}};
  for (report::Json::Member& member : report::cost_json(cost)) members.push_back(std::move(member));
  files::write_text(file, report::Json::object(members).text() + "\n");
}

}  // namespace

void declare_condense(CLI::App& app, CondenseArguments& arguments)
{
  CLI::App* condense = app.add_subcommand(
      "condense", "makes small bodies of an assembly's large ones, for its vibrations in a band");
  declare_scene_arguments(*condense, arguments.scene);
  declare_stale(*condense, arguments.scene.stale);
  condense
      ->add_option("--tolerance", arguments.tolerance,
                   "largest relative error of a complex eigenvalue of the brake")
      ->type_name("ERROR")
      ->check(CLI::Range(1e-7, 0.5))
      ->capture_default_str();
  condense->add_option("--up-to-Hz", arguments.up_to_Hz, "the band: all oscillations up to here")
      ->type_name("HZ")
      ->check(CLI::Range(1e-3, 1e9))
      ->required();
  condense->footer(
      "The bodies are those of this brake: of its speeds, of friction from none to the scene's,\n"
      "and of no oscillation above the band. Name them in another scene:\n"
      "body = \"NAME.condensed/PART.body.h5\". The tolerance is relative to |lambda|: 1e-3 at 2 "
      "kHz\n"
      "is up to 13 1/s of growth; the largest error of a growth rate is printed.\n\n"
      "Example:\n"
      "  squeal condense scene.toml --output out --up-to-Hz 3000 --tolerance 1e-3");
}

void run_condense(const CondenseArguments& arguments)
{
  report::PhaseClock clock;
  const scene::Scene scene = scene::read_scene(arguments.scene.scene);
  cases::require_study(scene);
  tell_notes(scene);
  const cases::SquealFiles files = cases::squeal_files(scene, arguments.scene.output, {});
  const std::vector<std::filesystem::path> outputs = cases::condensed_files(scene, files);
  report::make_folder(outputs.front().parent_path());
  // Their folder has the name of the scene: nothing else writes there.
  SceneArguments own = arguments.scene;
  own.overwrite = true;
  const ReservedOutputs reserved = reserve_outputs(own, outputs);
  const cases::CondensedBrake brake =
      cases::condensed_brake(scene, files, stale_of(arguments.scene),
                             {.tolerance = arguments.tolerance, .up_to_Hz = arguments.up_to_Hz});
  clock.end_phase("condense");
  cases::write(brake);
  clock.end_phase("write");
  const report::Cost cost = report::cost_so_far(clock.phases());
  const squeal::CondensationError& error = brake.found.error;
  fmt::print(
      "{}\n\n{}\n{} eigenvalues up to {:.6g} Hz, in {} states of the brake, have errors up to "
      "{:.2g}, their growth rates up to {:.2g} 1/s\n",
      report::printable(scene.title), report::format_table(table_of(brake)), error.n_eigenvalues,
      arguments.up_to_Hz, error.n_states, error.eigenvalues, error.growth);
  if (error.n_unstable_beyond > 0) {
    fmt::print(
        "note: up to {} motions above {:.6g} Hz are unstable with these bodies; what lies "
        "there is not the brake's\n",
        error.n_unstable_beyond, arguments.up_to_Hz);
  }
  fmt::print("\n{}", report::format_table(report::cost_table(cost)));
  if (!arguments.scene.json.empty()) write_json(arguments.scene.json, brake, cost);
}

}  // namespace chladni::cli
