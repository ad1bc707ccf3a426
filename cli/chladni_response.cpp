#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "cases/fe_responses.hpp"
#include "cases/ranks.hpp"
#include "cases/scene_responses.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "cli/writer_mark.hpp"
#include "common/error.hpp"
#include "files/text_file.hpp"
#include "mbs_export/files/body_file.hpp"
#include "mbs_export/measured/measured_functions.hpp"
#include "mbs_export/responses/response_csv.hpp"
#include "mbs_export/responses/response_file.hpp"
#include "mbs_export/responses/universal_responses.hpp"
#include "report/describe_responses.hpp"
#include "report/page/responses.hpp"
#include "report/progress.hpp"

namespace chladni::cli {
namespace {

using std::filesystem::path;

/// What the command writes.
struct Files {
  path values, table, page, universal;  ///< the last one only if it is asked for

  std::vector<path> all() const
  {
    std::vector<path> files{values, table, page};
    if (!universal.empty()) files.push_back(universal);
    return files;
  }
};

Files files_of(const scene::Scene& scene, const ChladniArguments& arguments)
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

void write_and_print(const ChladniArguments& arguments, const Files& files,
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
  const Files files = files_of(scene, arguments);
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
  const Files files = files_of(scene, arguments);
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

}  // namespace chladni::cli
