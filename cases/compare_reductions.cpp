#include "cases/compare_reductions.hpp"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "cases/chosen_mesh.hpp"
#include "cases/fe_responses.hpp"
#include "cases/fe_solution.hpp"
#include "cases/ranks.hpp"
#include "cases/reduce_scene.hpp"
#include "common/error.hpp"
#include "mbs_export/make_body.hpp"

namespace chladni::cases {

namespace {

using reduce::Method;

/// The reduction alone: nothing that a body or a picture needs besides.
scene::Scene bare(scene::Scene scene)
{
  scene.mass_integrals = false;
  scene.mesh_errors = false;
  scene.pictures = scene::PictureChoice::none;
  scene.resultants = {};
  scene.stiffening.clear();
  scene.accuracy.reset();
  scene.squeal.reset();
  scene.body.keep = {};
  scene.body.interface_modes.clear();
  return scene;
}

double sum_of_ranks(double x)
{
  MPI_Allreduce(MPI_IN_PLACE, &x, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return x;
}

/// Phases before the reduction itself.
bool comes_before(const report::PhaseTime& phase)
{
  return phase.name == "mesh" || phase.name == "assembly";
}

double largest_or_zero(const Eigen::VectorXd& x)
{
  return x.size() > 0 ? x.maxCoeff() : 0.0;
}

/// Hz, just above the last frequency.
double end_of(const Eigen::VectorXd& omega)
{
  return 1.001 * omega[omega.size() - 1] / (2.0 * std::numbers::pi);
}

struct ComparedTrial {
  reduce::ReduceOptions how;
  std::string asked;
};

std::vector<ComparedTrial> all_trials(const ReductionTrials& trials, double up_to_Hz)
{
  std::vector<ComparedTrial> all{{.how = {.method = Method::guyan}, .asked = ""}};
  for (const Method method : {Method::craig_bampton, Method::mixed_interface, Method::rubin})
    for (const int modes : trials.modes) {
      all.push_back(
          {.how = {.method = method, .modes = modes}, .asked = fmt::format("{} modes", modes)});
    }
  for (const double tolerance : trials.tolerances) {
    all.push_back(
        {.how = {.method = Method::craig_bampton,
                 .tolerance = reduce::ModesByTolerance{tolerance, (1.0 + tolerance) * up_to_Hz}},
         .asked = fmt::format("tolerance {:g}", tolerance)});
  }
  return all;
}

/// The lowest elastic frequencies under the supports, rad/s.
Eigen::VectorXd frequencies_of(const mbs_export::ReducedSystem& system,
                               const std::vector<std::string>& fixed, Eigen::Index n)
{
  constexpr Eigen::Index rigid = 6;
  const int count = static_cast<int>(std::min(n + rigid, system.K.rows()));
  mbs_export::BodyOptions options{.fixed = fixed, .keep = {}, .interface_modes = {}, .damping = {}};
  options.keep.count = count;
  const mbs_export::ModalBody body = mbs_export::make_body(system, options);
  const Eigen::Index n_rigid = std::ranges::count(body.kinds, mbs_export::ModeKind::rigid);
  const Eigen::VectorXd elastic = body.omega.tail(body.omega.size() - n_rigid);
  return elastic.head(std::min(n, elastic.size()));
}

/// Of the first rank, which alone has the reduced system.
void compare(const mbs_export::ReducedSystem& system, const std::vector<std::string>& fixed,
             const Eigen::VectorXd& omega, ComparedReduction& row)
{
  const Eigen::VectorXd reduced = frequencies_of(system, fixed, omega.size());
  row.n_coordinates = static_cast<int>(system.K.rows());
  row.n_compared = static_cast<int>(reduced.size());
  const Eigen::VectorXd known = omega.head(reduced.size());
  row.error = largest_or_zero((reduced - known).cwiseAbs().cwiseQuotient(known));
  const Eigen::VectorXd told = mbs_export::estimated_errors(system.certificate);
  if (told.size() >= omega.size()) row.told = largest_or_zero(told.head(omega.size()));
}

ComparedReduction reduced_by(const scene::Scene& scene, const ComparedTrial& trial,
                             const linear::SolverOptions& solver, const Eigen::VectorXd& omega)
{
  ComparedReduction row{.method = std::string(reduce::name_of(trial.how.method)),
                        .asked = trial.asked};
  scene::Scene with = scene;
  with.reduce = trial.how;
  if (!trial.how.tolerance) with.reduce.certified_up_to_Hz = end_of(omega);
  try {
    const ReduceSummary summary = reduce_scene(with, {.text = "", .options = solver}, {});
    for (const report::PhaseTime& phase : summary.phases) {
      if (comes_before(phase)) continue;
      row.cpu_s += phase.cpu_s;
      row.wall_s += phase.wall_s;
    }
    row.cpu_s = sum_of_ranks(row.cpu_s);
    on_first_rank([&] { compare(summary.reduced, scene.body.fixed, omega, row); });
  } catch (const Error& error) {
    row.refusal = error.what();
  }
  return row;
}

/// Marks those that none beats in a cost.
void mark_best(std::vector<ComparedReduction>& rows, bool ComparedReduction::*mark,
               const std::function<double(const ComparedReduction&)>& cost)
{
  int most = 0;
  for (const ComparedReduction& row : rows) most = std::max(most, row.n_compared);
  const auto is_complete = [&](const ComparedReduction& row) {
    return row.refusal.empty() && row.n_compared == most;
  };
  for (ComparedReduction& row : rows) {
    row.*mark = is_complete(row) && std::ranges::none_of(rows, [&](const ComparedReduction& other) {
                  return is_complete(other) && other.error < row.error && cost(other) <= cost(row);
                });
  }
}

}  // namespace

ReductionComparison compare_reductions(const scene::Scene& asked, const ReductionTrials& trials,
                                       const linear::SolverOptions& solver,
                                       const ReduceProgress& progress)
{
  Phases phases(progress);
  scene::Scene scene = chosen_mesh(asked, supports_of(asked), solver, phases).scene;
  scene::Scene held = held_as_body(scene);
  const SupportedModel model = supported_model(bare(held), solver, phases);
  held.natural_modes = {.count = trials.n_frequencies + plate::n_free_motions(model.free)};
  const SceneModes modes = scene_modes(held, model, solver, phases);
  ReductionComparison found{.omega = modes.omega.tail(trials.n_frequencies),
                            .n_dofs = static_cast<int>(model.system.dofs.n_dofs()),
                            .modes_cpu_s = sum_of_ranks(phases.time_of("modes").cpu_s),
                            .reductions = {}};
  scene = bare(std::move(scene));
  const std::vector<ComparedTrial> all = all_trials(trials, end_of(found.omega));
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (progress) progress("reductions", double(i) / double(all.size()));
    found.reductions.push_back(reduced_by(scene, all[i], solver, found.omega));
  }
  mark_best(found.reductions, &ComparedReduction::is_best_in_time,
            [](const ComparedReduction& row) { return row.cpu_s; });
  mark_best(found.reductions, &ComparedReduction::is_best_in_size,
            [](const ComparedReduction& row) { return double(row.n_coordinates); });
  return found;
}

report::TextTable comparison_table(const ReductionComparison& found)
{
  report::TextTable table{.header = {"method", "asked", "coordinates", "largest error", "estimated",
                                     "CPU, s", "best in"},
                          .rows = {}};
  for (const ComparedReduction& row : found.reductions) {
    if (!row.refusal.empty()) {
      table.rows.push_back({row.method, row.asked, "-", "-", "-", "-", "-"});
      continue;
    }
    const bool is_short = row.n_compared < found.omega.size();
    const std::string error = fmt::format("{:.1e}", row.error);
    table.rows.push_back({row.method, row.asked, fmt::format("{}", row.n_coordinates),
                          is_short ? fmt::format("{} of {} alone", error, row.n_compared) : error,
                          row.told > 0.0 ? fmt::format("{:.1e}", row.told) : "",
                          fmt::format("{:.3f}", row.cpu_s),
                          row.is_best_in_time && row.is_best_in_size ? "time, size"
                          : row.is_best_in_time                      ? "time"
                          : row.is_best_in_size                      ? "size"
                                                                     : ""});
  }
  return table;
}

std::vector<report::Json::Member> comparison_json(const ReductionComparison& found)
{
  std::vector<report::Json> rows;
  for (const ComparedReduction& row : found.reductions) {
    rows.push_back(report::Json::object({{"method", row.method},
                                         {"asked", row.asked},
                                         {"n_coordinates", row.n_coordinates},
                                         {"n_compared", row.n_compared},
                                         {"error", row.error},
                                         {"estimated_error", row.told},
                                         {"cpu_s", row.cpu_s},
                                         {"wall_s", row.wall_s},
                                         {"refusal", row.refusal},
                                         {"is_best_in_time", row.is_best_in_time},
                                         {"is_best_in_size", row.is_best_in_size}}));
  }
  return {{"n_dofs", found.n_dofs},
          {"frequencies_Hz", report::frequencies_json(found.omega)},
          {"modes_cpu_s", found.modes_cpu_s},
          {"reductions", report::Json::array(rows)}};
}

namespace {

/// An axis of powers of ten.
struct LogAxis {
  double from, to;        ///< exponents
  double at_from, at_to;  ///< places in the picture

  double operator()(double x) const
  {
    const double exponent = std::log10(std::max(x, std::pow(10.0, from)));
    return at_from + (exponent - from) / (to - from) * (at_to - at_from);
  }
};

/// @param steps  to a decade at which the axis may begin and end
LogAxis axis_over(const std::vector<double>& values, double steps, double at_from, double at_to)
{
  double least = 1e300, most = 1e-300;
  for (const double x : values) {
    least = std::min(least, std::max(x, 1e-12));
    most = std::max(most, x);
  }
  const double from = std::floor(std::log10(least) * steps) / steps,
               to = std::ceil(std::log10(most) * steps) / steps;
  return {.from = from, .to = std::max(to, from + 0.3), .at_from = at_from, .at_to = at_to};
}

/// At 1, 2 and 5 of each decade, or at each decade where these are many.
std::string ticks(const LogAxis& axis, bool is_vertical, double at)
{
  constexpr double few = 2.5, slack = 1e-9;
  std::string svg;
  for (int k = int(std::floor(axis.from)); k <= int(axis.to) + 1; ++k) {
    for (const double step : {1.0, 2.0, 5.0}) {
      const double value = step * std::pow(10.0, k), exponent = std::log10(value);
      if (exponent < axis.from - slack || exponent > axis.to + slack) continue;
      if (step > 1.0 && axis.to - axis.from > few) continue;
      const double place = axis(value);
      svg += is_vertical
                 ? fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='end'>{:g}</text>\n",
                               at - 6.0, place + 4.0, value)
                 : fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{:g}</text>\n",
                               place, at + 18.0, value);
    }
  }
  return svg;
}

constexpr std::array<std::pair<const char*, const char*>, 4> colours{
    {{"guyan", "#7a7a7a"},
     {"craig-bampton", "#1f5fa8"},
     {"mixed-interface", "#2e8b57"},
     {"rubin", "#b5472f"}}};

/// One panel, 0 or 1 from the left.
std::string panel(const ReductionComparison& found, int place, const char* title,
                  const std::function<double(const ComparedReduction&)>& cost)
{
  std::vector<double> costs, errors;
  for (const ComparedReduction& row : found.reductions) {
    if (!row.refusal.empty()) continue;
    costs.push_back(cost(row));
    errors.push_back(row.error);
  }
  if (costs.empty()) return {};
  const double left = 70.0 + 400.0 * place, right = left + 310.0, top = 50.0, bottom = 350.0;
  const LogAxis x = axis_over(costs, 10.0, left, right), y = axis_over(errors, 1.0, bottom, top);
  std::string svg = fmt::format(
      "<rect x='{}' y='{}' width='{}' height='{}' fill='none' stroke='#999'/>\n"
      "<text x='{}' y='{}' text-anchor='middle'>{}</text>\n",
      left, top, right - left, bottom - top, 0.5 * (left + right), bottom + 38.0, title);
  svg += ticks(x, false, bottom) + ticks(y, true, left);
  for (const auto& [method, colour] : colours) {
    for (const ComparedReduction& row : found.reductions) {
      if (row.method != method || !row.refusal.empty()) continue;
      svg += fmt::format(
          "<circle cx='{:.1f}' cy='{:.1f}' r='4.5' fill='{}' stroke='{}'><title>{} {}: error "
          "{:.1e}, {} coordinates, "
          "{:.3f} s</title></circle>\n",
          x(cost(row)), y(row.error), row.asked.starts_with("tolerance") ? "white" : colour, colour,
          row.method, row.asked, row.error, row.n_coordinates, row.cpu_s);
    }
  }
  return svg;
}

}  // namespace

std::string comparison_picture(const ReductionComparison& found)
{
  std::string svg =
      "<svg xmlns='http://www.w3.org/2000/svg' width='800' height='410' font-family='sans-serif' "
      "font-size='12'>\n<rect width='800' height='410' fill='white'/>\n";
  svg +=
      fmt::format("<text x='70' y='20'>Largest relative error of the first {} frequencies</text>\n",
                  found.omega.size());
  double at = 70.0;
  for (const auto& [method, colour] : colours) {
    svg += fmt::format("<circle cx='{}' cy='36' r='4.5' fill='{}'/><text x='{}' y='40'>{}</text>\n",
                       at + 5.0, colour, at + 14.0, method);
    at += 130.0;
  }
  svg += fmt::format(
      "<circle cx='{}' cy='36' r='4.5' fill='white' stroke='#1f5fa8'/>"
      "<text x='{}' y='40'>by tolerance</text>\n",
      at + 5.0, at + 14.0);
  svg += panel(found, 0, "CPU time of the reduction, s",
               [](const ComparedReduction& row) { return row.cpu_s; });
  svg += panel(found, 1, "coordinates of the reduced system",
               [](const ComparedReduction& row) { return double(row.n_coordinates); });
  return svg + "</svg>\n";
}

}  // namespace chladni::cases
