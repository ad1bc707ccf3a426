#include "cli/chladni_steps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <utility>

#include "cases/ranks.hpp"
#include "cases/scene_body.hpp"
#include "files/text_file.hpp"
#include "report/progress.hpp"
#include "report/version.hpp"

namespace chladni::cli {

scene::Scene read_scene_to_mesh(const ChladniArguments& arguments, scene::Purpose purpose)
{
  scene::Scene scene = scene::read_meshed_scene(arguments.scene.scene, purpose);
  if (arguments.trusts_mesh) scene.mesh.trust = mesh::Trust::owner;
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

namespace {

/// The phases of a reduction in their order, and their usual parts of the time, per cent.
std::vector<report::Stage> stages_of(const reduce::ReduceOptions& wanted)
{
  using report::Times;
  std::vector<report::Stage> stages{
      {"mesh", 1.0}, {"assembly", 3.0}, {"partition", 1.0}, {"factorization", 4.0}};
  const report::Stage constraint{"constraint modes", 4.0};
  const auto add = [&](const std::vector<report::Stage>& more) {
    stages.insert(stages.end(), more.begin(), more.end());
  };
  if (wanted.method == reduce::Method::guyan)
    add({constraint});
  else if (wanted.method == reduce::Method::mixed_interface)
    add({constraint, {"mixed-interface modes", 25.0}, {"residual flexibility", 5.0}});
  else if (wanted.method == reduce::Method::automatic)
    add({constraint,
         {"fixed-interface modes", 25.0, Times::unknown},
         {"mixed-interface modes", 25.0},
         {"residual flexibility", 5.0}});
  else if (wanted.method != reduce::Method::craig_bampton)
    add({constraint, {"free-interface modes", 25.0}, {"residual flexibility", 5.0}});
  else if (wanted.tolerance)
    add({constraint, {"fixed-interface modes", 40.0, Times::unknown}});
  else
    add({{"fixed-interface modes", 20.0}, constraint});
  add({{"projection", 6.0},
       {"error estimates", 8.0},
       {"condition", 1.0},
       {"count of eigenvalues", 15.0},
       {"residuals", 2.0},
       {"mass integrals", 25.0},
       {"pictures", 1.0}});
  return stages;
}

/// The phases of a reduction from one sector.
std::vector<report::Stage> stages_of_sectors()
{
  return {{"mesh", 2.0},       {"assembly", 4.0},   {"modes of harmonics", 14.0},
          {"harmonics", 60.0}, {"whole body", 2.0}, {"mass integrals", 16.0},
          {"pictures", 2.0}};
}

}  // namespace

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
  const cases::ReduceProgress whole = bar(stages_of(scene.reduce)),
                              sectors = bar(stages_of_sectors());
  return [whole, sectors, found = false](const std::string& phase, double fraction) mutable {
    found = found || phase == "modes of harmonics";
    (found ? sectors : whole)(phase, fraction);
  };
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

namespace {

/// "101 (100 asked; 1 more of the same frequency)": what a disc has twice is not parted.
std::string number_of_modes(const cases::ReduceSummary& summary)
{
  const int n_more = summary.n_modes - summary.n_modes_asked;
  if (summary.n_modes_asked == 0 || n_more == 0) return fmt::format("{}", summary.n_modes);
  return fmt::format("{} ({} asked; {} more of the same frequency)", summary.n_modes,
                     summary.n_modes_asked, n_more);
}

}  // namespace

namespace {

/// Of the frequencies: the estimate, or what rounding may do where that is more.
double largest_error(const mbs_export::Certificate& certificate)
{
  const double estimate = mbs_export::estimated_errors(certificate).maxCoeff();
  if (certificate.rounding.size() == 0) return estimate;
  return std::max(estimate, 0.5 * certificate.rounding.maxCoeff());
}

}  // namespace

report::TextTable reduction_table(const cases::ReduceSummary& summary)
{
  report::TextTable table{.header = {"reduction", "value"}, .rows = {}};
  table.rows.push_back({"nodes of the mesh", fmt::format("{}", summary.n_nodes)});
  table.rows.push_back({"DOFs", fmt::format("{}", summary.n_dofs)});
  table.rows.push_back({"masters", fmt::format("{}", summary.n_masters)});
  table.rows.push_back({"method", std::string(reduce::name_of(summary.choice.method))});
  table.rows.push_back({"modes", number_of_modes(summary)});
  const mbs_export::Certificate& certificate = summary.reduced.certificate;
  if (const Eigen::Index n = certificate.eta2.size(); n > 0) {
    table.rows.push_back({fmt::format("estimated error of the frequencies up to {:.0f} Hz",
                                      certificate.frequencies[n - 1] / (2.0 * std::numbers::pi)),
                          fmt::format("{:.1e}", largest_error(certificate))});
  }
  if (certificate.mesh_errors.size() > 0) {
    table.rows.push_back({"estimated error of these by the mesh",
                          fmt::format("{:.1e}", certificate.mesh_errors.maxCoeff())});
  }
  if (const mbs_export::ModeCount& count = certificate.range; count.up_to > 0.0) {
    table.rows.push_back(
        {fmt::format("modes up to {:.0f} Hz", count.up_to / (2.0 * std::numbers::pi)),
         fmt::format("{} of {}{}", count.found, count.expected,
                     count.missing() > 0 ? ": take more modes" : "")});
  }
  table.rows.push_back(
      {"CPU of the factorisation, s", fmt::format("{:.3f}", summary.factorization.cpu_s)});
  return table;
}

std::string described_reduction(const cases::ReduceSummary& summary)
{
  const std::string table = report::format_table(reduction_table(summary));
  if (summary.choice.reason.empty()) return table;
  return fmt::format("{}{} was chosen since\n  {}\n", table, reduce::name_of(summary.choice.method),
                     summary.choice.reason);
}

std::vector<report::Json::Member> reduction_json(const cases::ReduceSummary& summary)
{
  return {
      {"n_dofs", summary.n_dofs},
      {"n_nodes", summary.n_nodes},
      {"n_masters", summary.n_masters},
      {"method", std::string(reduce::name_of(summary.choice.method))},
      {"why_this_method", summary.choice.reason},
      {"n_modes", summary.n_modes},
      {"certified_frequencies_Hz", frequencies_json(summary.reduced.certificate.frequencies)},
      {"eta2", numbers_json(summary.reduced.certificate.eta2)},
      {"estimated_errors", numbers_json(mbs_export::estimated_errors(summary.reduced.certificate))},
      {"rounding", numbers_json(summary.reduced.certificate.rounding)},
      {"bounds", numbers_json(summary.reduced.certificate.bounds)},
      {"modes_expected", summary.reduced.certificate.range.expected},
      {"modes_found", summary.reduced.certificate.range.found},
      {"condition_K_ss", summary.reduced.certificate.condition},
      {"factor_wall_s", summary.factorization.wall_s},
      {"factor_cpu_s", summary.factorization.cpu_s},
      {"modes_residual", summary.modes_residual},
      {"factor_operations", summary.factor.operations},
      {"factor_entries", summary.factor.entries}};
}

report::Json numbers_json(const Eigen::VectorXd& values)
{
  std::vector<report::Json> numbers;
  for (const double value : values) numbers.emplace_back(value);
  return report::Json::array(numbers);
}

report::Json frequencies_json(const Eigen::VectorXd& omega)
{
  std::vector<report::Json> f_Hz;
  for (const double omega_i : omega) f_Hz.emplace_back(omega_i / (2.0 * std::numbers::pi));
  return report::Json::array(f_Hz);
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
