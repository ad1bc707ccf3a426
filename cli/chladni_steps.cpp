#include "cli/chladni_steps.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <numbers>

#include "cli/petsc_session.hpp"
#include "cli/version.hpp"
#include "common/error.hpp"
#include "mbs_export/make_body.hpp"

namespace chladni::cli {

std::filesystem::path reduced_file(const Scene& scene, const SceneArguments& arguments)
{
  return std::filesystem::path(arguments.output) / (scene.name + ".reduced.h5");
}

std::filesystem::path body_file(const Scene& scene, const SceneArguments& arguments)
{
  return std::filesystem::path(arguments.output) / (scene.name + ".body.h5");
}

namespace {

/// PETSc's options from the environment and behind `--`.
std::string said_of_solvers(const ChladniArguments& arguments)
{
  const char* environment = std::getenv("PETSC_OPTIONS");
  std::vector<std::string> said;
  if (environment != nullptr && *environment != '\0') said.emplace_back(environment);
  said.insert(said.end(), arguments.petsc_options.begin(), arguments.petsc_options.end());
  return fmt::format("{}", fmt::join(said, " "));
}

}  // namespace

ReduceSummary reduce_with_progress(const Scene& scene, const ChladniArguments& arguments)
{
  if (scene.interface_nodes.empty()) {
    throw Error(fmt::format("{}: interface is missing: a reduction needs [interface] and [reduce]",
                            scene.path));
  }
  const SaidOfSolvers solvers{.text = said_of_solvers(arguments), .options = arguments.solver};
  if (rank() != 0) return reduce_scene(scene, solvers, [](const std::string&, double) {});
  ProgressLine line;
  return reduce_scene(scene, solvers, [&](const std::string& phase, double fraction) {
    line.show(phase, fraction);
  });
}

mbs_export::ModalBody make_body_of(const Scene& scene, const mbs_export::ReducedSystem& reduced)
{
  mbs_export::ModalBody body = mbs_export::make_body(reduced, scene.body);
  if (scene.squeal && body.n_free_rigid > 0) {
    throw Error(
        fmt::format("{}: body.fixed = [{}] leaves the body free to move as a rigid one in {} ways, "
                    "but [squeal] "
                    "needs a body that is held; hold an interface node ({}) with all its DOFs, or "
                    "take [squeal] "
                    "out",
                    scene.path, fmt::join(scene.body.fixed, ", "), body.n_free_rigid,
                    fmt::join(scene.interface_nodes, ", ")));
  }
  body.provenance.scene = scene.text;  // of the body, which may be younger than the reduction
  return body;
}

PhaseTime time_of_all_ranks(const PhaseTime& time)
{
  return {.name = time.name,
          .wall_s = largest_of_ranks(time.wall_s),
          .cpu_s = sum_over_ranks(time.cpu_s)};
}

Cost cost_of_all_ranks(const std::vector<PhaseTime>& phases)
{
  Cost cost{.phases = {},
            .wall_s = largest_of_ranks(process_wall_s()),
            .cpu_s = sum_over_ranks(process_cpu_s()),
            .peak_MiB = largest_of_ranks(peak_MiB())};
  for (const PhaseTime& phase : phases) cost.phases.push_back(time_of_all_ranks(phase));
  return cost;
}

namespace {

/// "101 (100 asked; 1 more of the same frequency)": what a disc has twice is not parted.
std::string number_of_modes(const ReduceSummary& summary)
{
  const int n_more = summary.n_modes - summary.n_modes_asked;
  if (summary.n_modes_asked == 0 || n_more == 0) return fmt::format("{}", summary.n_modes);
  return fmt::format("{} ({} asked; {} more of the same frequency)", summary.n_modes,
                     summary.n_modes_asked, n_more);
}

}  // namespace

TextTable reduction_table(const ReduceSummary& summary)
{
  TextTable table{.header = {"reduction", "value"}, .rows = {}};
  table.rows.push_back({"nodes of the mesh", fmt::format("{}", summary.n_nodes)});
  table.rows.push_back({"DOFs", fmt::format("{}", summary.n_dofs)});
  table.rows.push_back({"masters", fmt::format("{}", summary.n_masters)});
  table.rows.push_back({"fixed-interface modes", number_of_modes(summary)});
  const mbs_export::Certificate& certificate = summary.reduced.certificate;
  if (const Eigen::Index n = certificate.eta2.size(); n > 0) {
    table.rows.push_back(
        {fmt::format("estimated error of the frequencies up to {:.0f} Hz",
                     certificate.frequencies[n - 1] / (2.0 * std::numbers::pi)),
         fmt::format("{:.1e}", mbs_export::estimated_errors(certificate).maxCoeff())});
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

std::vector<Json::Member> reduction_json(const ReduceSummary& summary)
{
  return {
      {"n_dofs", summary.n_dofs},
      {"n_nodes", summary.n_nodes},
      {"n_masters", summary.n_masters},
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

Json numbers_json(const Eigen::VectorXd& values)
{
  std::vector<Json> numbers;
  for (const double value : values) numbers.emplace_back(value);
  return Json::array(numbers);
}

Json frequencies_json(const Eigen::VectorXd& omega)
{
  std::vector<Json> f_Hz;
  for (const double omega_i : omega) f_Hz.emplace_back(omega_i / (2.0 * std::numbers::pi));
  return Json::array(f_Hz);
}

void write_summary(const SceneArguments& arguments, const std::vector<Json::Member>& members,
                   const Cost& cost)
{
  if (arguments.json.empty()) return;
  std::vector<Json::Member> all = {{"program", "chladni"}, {"version", version}};
  all.insert(all.end(), members.begin(), members.end());
  for (Json::Member& member : cost_json(cost)) all.push_back(std::move(member));
  write_text_atomically(arguments.json, Json::object(all).text() + "\n");
}

}  // namespace chladni::cli
