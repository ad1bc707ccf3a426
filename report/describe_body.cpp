#include "report/describe_body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "common/files/hdf5.hpp"
#include "common/told_apart.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mbs_export/responses/response_files.hpp"
#include "report/describe_responses.hpp"
#include "report/describe_squeal.hpp"
#include "report/text_table.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/sweep_table.hpp"

namespace chladni::report {

using Eigen::Index;

namespace {

using std::numbers::pi;

void add_sets(TextTable& table, const std::vector<mbs_export::AttachmentSet>& sets)
{
  for (const mbs_export::AttachmentSet& set : sets) {
    add_count(table, fmt::format("nodes of {}", set.name),
              static_cast<Eigen::Index>(set.nodes.size()));
  }
}

void add_picture(TextTable& table, const mbs_export::Picture& picture)
{
  add_count(table, "nodes for pictures", picture.positions.rows());
}

using Steps = std::vector<mbs_export::SelectionStep>;

/// The last step that needs no more than `size` modes; null before the first and after the last.
const mbs_export::SelectionStep* step_at(const Steps& steps, int size)
{
  if (steps.empty() || size > steps.back().size()) return nullptr;
  const auto after = std::ranges::upper_bound(steps, size, {}, &mbs_export::SelectionStep::size);
  return after == steps.begin() ? nullptr : &*(after - 1);
}

/// Sizes at which the error of a path falls to another half of a power of ten, and the last one.
void add_telling_sizes(std::set<int>& sizes, const Steps& steps)
{
  int last = std::numeric_limits<int>::max();
  for (const mbs_export::SelectionStep& step : steps) {
    const int level = static_cast<int>(std::floor(2.0 * std::log10(step.error + 1e-300)));
    if (level < last || &step == &steps.back()) sizes.insert(step.size());
    last = std::min(last, level);
  }
}

TextTable selection_table(const mbs_export::SelectionTable& selection)
{
  std::set<int> sizes;
  add_telling_sizes(sizes, selection.modes_only);
  add_telling_sizes(sizes, selection.with_interface_modes);
  TextTable table{
      .header = {"size", "error, modes alone", "error, with interface modes", "interface modes"},
      .rows = {}};
  for (const int size : sizes) {
    const auto* modes = step_at(selection.modes_only, size);
    const auto* mixed = step_at(selection.with_interface_modes, size);
    table.rows.push_back({fmt::format("{}", size),
                          modes != nullptr ? fmt::format("{:.2e}", modes->error) : "",
                          mixed != nullptr ? fmt::format("{:.2e}", mixed->error) : "",
                          mixed != nullptr ? fmt::format("{}", mixed->n_interface) : ""});
  }
  return table;
}

template <class Object>
std::string titled(const Object& object)
{
  return printable(object.title) + "\n\n" + format_table(describe(object));
}

/// The highest harmonic of each ring that has harmonics as masters.
void add_harmonics(TextTable& table, const mbs_export::ReducedSystem& reduced)
{
  for (std::size_t set = 0; set < reduced.sets.size(); ++set) {
    int highest = -1;
    for (const mbs_export::MasterDof& dof : reduced.masters)
      if (dof.harmonic && dof.harmonic->set == static_cast<int>(set))
        highest = std::max(highest, dof.harmonic->order);
    if (highest >= 0)
      add_count(table, "harmonics of " + reduced.sets[set].name + " up to", highest);
  }
}

void add_stiffening(TextTable& table, const std::optional<mbs_export::Stiffening>& stiffening)
{
  if (!stiffening) return;
  table.rows.push_back(
      {"geometric stiffness by", fmt::format("{}", fmt::join(stiffening->loads, " ")), ""});
}

}  // namespace

std::string name_of(mbs_export::ModeKind kind)
{
  switch (kind) {
    case mbs_export::ModeKind::rigid:
      return "rigid";
    case mbs_export::ModeKind::constrained:
      return "constrained";
    case mbs_export::ModeKind::interface:
      return "interface";
  }
  return "";
}

TextTable describe(const mbs_export::ReducedSystem& reduced)
{
  TextTable table = quantities();
  add_count(table, "attachment nodes", static_cast<Eigen::Index>(reduced.attachment_nodes.size()));
  add_sets(table, reduced.sets);
  add_harmonics(table, reduced);
  add_count(table, "masters", reduced.n_masters());
  const Eigen::VectorXd f_Hz = reduced.fixed_interface_frequencies / (2.0 * pi);
  add_count(table, "modes with held masters", f_Hz.size());
  if (f_Hz.size() > 0) {
    add(table, "lowest of them", f_Hz.minCoeff(), "Hz");
    add(table, "highest of them", f_Hz.maxCoeff(), "Hz");
  }
  add_stiffening(table, reduced.stiffening);
  add_picture(table, reduced.picture);
  return table;
}

TextTable describe(const mbs_export::ModalBody& body)
{
  TextTable table = quantities();
  add_count(table, "modes", body.n_modes());
  add_count(table, "rigid-body motions of the free body", body.n_rigid);
  add_count(table, "rigid-body motions left by the supports", body.n_free_rigid);
  add(table, "condition of the mode shift", body.condition_Q_dd, "");
  if (body.preparation.condition_directions)
    add(table, "condition with rows of unit length", *body.preparation.condition_directions, "");
  add_count(table, "attachment nodes", static_cast<Eigen::Index>(body.attachment_nodes.size()));
  add_sets(table, body.sets);
  add_count(table, "contact rings", static_cast<Eigen::Index>(body.rings.size()));
  add(table, "mass", body.mass, "kg");
  add(table, "moment of inertia about z", body.inertia(2, 2), "kg m^2");
  add_stiffening(table, body.stiffening);
  add_picture(table, body.picture);
  if (body.condensation) {
    table.rows.push_back(
        {"condensed for the vibrations of", printable(body.condensation->brake), ""});
    add(table, "up to", body.condensation->highest / (2.0 * pi), "Hz");
    add(table, "largest error of its eigenvalues", body.condensation->error, "");
  }
  return table;
}

TextTable list_modes(const mbs_export::ModalBody& body)
{
  TextTable table{.header = {"mode", "frequency, Hz", "kind"}, .rows = {}};
  if (body.C.size() > 0) table.header.emplace_back("damping ratio");
  const Eigen::VectorXd eta = mbs_export::loss_factors(body);
  if (eta.size() > 0) table.header.emplace_back("loss factor");
  for (Eigen::Index i = 0; i < body.n_modes(); ++i) {
    std::vector<std::string> row{fmt::format("{}", i + 1),
                                 fmt::format("{:.4f}", body.omega[i] / (2.0 * pi)),
                                 name_of(body.kinds[static_cast<std::size_t>(i)])};
    const bool is_elastic = body.omega[i] > 0.0;
    if (body.C.size() > 0)
      row.push_back(is_elastic ? fmt::format("{:.3g}", 0.5 * body.C(i, i) / body.omega[i]) : "");
    if (eta.size() > 0) row.push_back(is_elastic ? fmt::format("{:.3g}", eta[i]) : "");
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string describe_selection(const mbs_export::ModalBody& body)
{
  if (!body.selection) return "";
  const mbs_export::SelectionTable& selection = *body.selection;
  const auto n_interface = std::ranges::count(body.kinds, mbs_export::ModeKind::interface);
  const Steps& steps = n_interface > 0 ? selection.with_interface_modes : selection.modes_only;
  const double of_body = steps.empty() ? 0.0 : steps.back().error;
  const double error = of_body + selection.of_reduction.value_or(0.0);
  const auto [reached, tolerance] = told_apart(error, selection.error, 3);
  return fmt::format(
      "selection for loads at {} up to {:.6g} Hz, tolerance {}\n\n{}\n{}: {} modes and {} "
      "interface modes, error {} beside the {}\n",
      fmt::join(selection.loads, ", "), selection.Omega_max / (2.0 * pi), tolerance,
      format_table(selection_table(selection)),
      error <= selection.error ? "chosen" : "the tolerance cannot be reached; the best is",
      body.n_modes() - n_interface, n_interface, reached,
      selection.of_reduction
          ? fmt::format("FE model, of which {:.2e} of the reduction", *selection.of_reduction)
          : "reduced system");
}

std::string describe_file(const std::filesystem::path& path)
{
  const files::Reader file(path.string());  // one for all: its seal is a digest of it
  const std::string format = file.text_attribute("/", "format");
  if (format == mbs_export::reduced_format) {
    const mbs_export::ReducedSystem reduced = mbs_export::read_reduced(file);
    const std::string certificate = describe_certificate(reduced.certificate);
    return titled(reduced) + (certificate.empty() ? "" : "\n" + certificate);
  }
  if (format == mbs_export::body_format) {
    const mbs_export::ModalBody body = mbs_export::read_body(file);
    const std::string selection = describe_selection(body);
    const bool is_certified = body.fixed == body.certificate.fixed;  // or it is of other modes
    const std::string certificate = is_certified ? describe_certificate(body.certificate) : "";
    return titled(body) + "\n" + format_table(list_modes(body)) +
           (selection.empty() ? "" : "\n" + selection) +
           (certificate.empty() ? "" : "\n" + certificate);
  }
  if (format == mbs_export::response_format) {
    const mbs_export::FrequencyResponses responses = mbs_export::read_responses(file);
    const bool is_measured = !responses.measured.functions.empty();
    return titled(responses) + "\n" + format_table(list_peaks(responses)) +
           (is_measured ? "\n" + format_table(list_measured(responses)) : "");
  }
  if (format == squeal::sweep_format) return format_table(describe(squeal::read_sweep(file)));
  if (format == squeal::results_format) return format_table(describe(squeal::read_results(file)));
  throw Error(
      fmt::format("{}: holds \"{}\", which this program does not know", file.path(), format));
}

namespace {

constexpr Index most_lines = 20;

void add_count(TextTable& table, const char* what, const mbs_export::ModeCount& count)
{
  if (count.up_to == 0.0) return;
  table.rows.push_back(
      {fmt::format("{} below {:.6g} Hz", what, count.up_to / (2.0 * pi)),
       fmt::format("{} expected, {} found, {} missing{}", count.expected, count.found,
                   count.missing(), count.missing() > 0 ? ": take more modes" : "")});
}

/// Where rounding may change a frequency by more than what the basis lacks, by how much at most.
std::optional<double> limit_by_rounding(const mbs_export::Certificate& certificate)
{
  constexpr double noticeable = 1e-6;
  double limit = 0.0;
  for (Index i = 0; i < certificate.rounding.size(); ++i) {
    const double of_frequency = 0.5 * certificate.rounding[i];
    if (of_frequency > certificate.estimates[i]) limit = std::max(limit, of_frequency);
  }
  return limit > noticeable ? std::optional(limit) : std::nullopt;
}

std::string completeness_unchecked(const mbs_export::Certificate& certificate)
{
  const std::string share = certificate.count_share > 0.0
                                ? fmt::format(", for about {:.0f} % of the reduction's time",
                                              100.0 * certificate.count_share)
                                : std::string();
  return fmt::format("not checked: [reduce] sylvester = true counts the modes{}", share);
}

TextTable quality_table(const mbs_export::Certificate& certificate)
{
  TextTable table{.header = {"certificate", "value"}, .rows = {}};
  table.rows.push_back({"support", certificate.fixed.empty()
                                       ? std::string("none")
                                       : fmt::format("{}", fmt::join(certificate.fixed, ", "))});
  table.rows.push_back(
      {"largest estimated error of a frequency",
       fmt::format("{:.2e}", mbs_export::estimated_errors(certificate).maxCoeff())});
  if (certificate.mesh_errors.size() > 0) {
    table.rows.push_back({"largest estimated error of one by the mesh",
                          fmt::format("{:.2e}", certificate.mesh_errors.maxCoeff())});
  }
  if (const auto limit = limit_by_rounding(certificate))
    table.rows.push_back({"limited by rounding to about", fmt::format("{:.0e}", *limit)});
  table.rows.push_back(
      {"zero-energy modes of the free body", fmt::format("{}", certificate.n_rigid)});
  if (certificate.n_rigid > 0) {
    table.rows.push_back({"their energy over the first elastic omega^2",
                          fmt::format("{:.1e}", certificate.rigid_residual)});
  }
  if (certificate.condition > 0.0)
    table.rows.push_back({"condition of K_ss", fmt::format("{:.1e}", certificate.condition)});
  if (const auto& responses = certificate.responses) {
    table.rows.push_back(
        {fmt::format("bound of the error of responses at {} up to {:.0f} Hz",
                     fmt::join(responses->loads, ", "), responses->up_to / (2.0 * pi)),
         fmt::format("{:.1e}", responses->error)});
  }
  add_count(table, "fixed-interface modes", certificate.fixed_interface);
  add_count(table, "modes", certificate.range);
  if (certificate.complete.up_to != certificate.range.up_to)
    add_count(table, "modes", certificate.complete);
  if (certificate.range.up_to == 0.0)
    table.rows.push_back({"completeness", completeness_unchecked(certificate)});
  return table;
}

TextTable mode_table(const mbs_export::Certificate& certificate)
{
  TextTable table{.header = {"mode", "frequency, Hz", "estimated error"}, .rows = {}};
  const bool has_bounds = certificate.bounds.size() > 0;
  if (has_bounds) table.header.emplace_back("bound");
  const Eigen::VectorXd& of_mesh = certificate.mesh_errors;
  if (of_mesh.size() > 0) table.header.emplace_back("error of the mesh");
  const Eigen::VectorXd errors = mbs_export::estimated_errors(certificate);
  for (Index i = 0; i < std::min(most_lines, errors.size()); ++i) {
    table.rows.push_back({fmt::format("{}", i + 1),
                          fmt::format("{:.4f}", certificate.frequencies[i] / (2.0 * pi)),
                          fmt::format("{:.2e}", errors[i])});
    if (has_bounds) {
      table.rows.back().push_back(
          i < certificate.bounds.size() ? fmt::format("{:.2e}", 0.5 * certificate.bounds[i]) : "");
    }
    if (of_mesh.size() > 0)
      table.rows.back().push_back(i < of_mesh.size() ? fmt::format("{:.2e}", of_mesh[i]) : "");
  }
  return table;
}

}  // namespace

std::string describe_certificate(const mbs_export::Certificate& certificate)
{
  const Index n = certificate.eta2.size();
  if (n == 0) return "";
  return fmt::format(
      "{}\n{}{}", format_table(quality_table(certificate)), format_table(mode_table(certificate)),
      n > most_lines ? fmt::format("... {} more in the file\n", n - most_lines) : std::string());
}

namespace {

Json steps_json(const std::vector<mbs_export::SelectionStep>& steps)
{
  std::vector<Json> list;
  for (const mbs_export::SelectionStep& step : steps) {
    list.push_back(Json::object({{"added", step.added},
                                 {"modes", step.n_modes},
                                 {"interface_modes", step.n_interface},
                                 {"error", step.error}}));
  }
  return Json::array(list);
}

}  // namespace

std::vector<Json::Member> preparation_json(const mbs_export::ModalBody& body)
{
  std::vector<Json::Member> members = {
      {"condition_Q_dd", body.condition_Q_dd},
      {"interface_modes_dropped", body.preparation.n_interface_dropped}};
  if (body.preparation.condition_directions)
    members.emplace_back("condition_directions", *body.preparation.condition_directions);
  if (!body.selection) return members;
  const mbs_export::SelectionTable& table = *body.selection;
  const std::vector<Json> loads(table.loads.begin(), table.loads.end());
  members.emplace_back(
      "selection",
      Json::object({{"tolerance", table.error},
                    {"error_of_reduction", table.of_reduction ? Json(*table.of_reduction) : Json()},
                    {"up_to_Hz", table.Omega_max / (2.0 * std::numbers::pi)},
                    {"loads", Json::array(loads)},
                    {"modes_only", steps_json(table.modes_only)},
                    {"with_interface_modes", steps_json(table.with_interface_modes)}}));
  return members;
}

}  // namespace chladni::report
