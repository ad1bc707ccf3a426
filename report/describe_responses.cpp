#include "report/describe_responses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "mbs_export/responses/frequency_responses.hpp"
#include "report/json.hpp"
#include "report/text_table.hpp"

namespace chladni::report {

using Eigen::Index;
using mbs_export::FrequencyResponses, mbs_export::MeasuredModes, mbs_export::ModalAssurance,
    mbs_export::ResponsePoint;

namespace {

using std::numbers::pi;
constexpr std::size_t most = 40;  // rows of a table

/// A load, an output, and its largest amplitude.
struct FoundPeak {
  std::size_t load, output;
  Peak peak;
};

std::vector<FoundPeak> all_peaks(const FrequencyResponses& responses)
{
  std::vector<FoundPeak> all;
  for (std::size_t l = 0; l < responses.loads.size(); ++l)
    for (std::size_t o = 0; o < responses.outputs.size(); ++o)
      all.push_back({l, o, peak_of(responses, l, static_cast<Eigen::Index>(o))});
  return all;
}

Json names_of(const std::vector<ResponsePoint>& points)
{
  std::vector<Json> names;
  for (const ResponsePoint& point : points) names.emplace_back(point.name);
  return Json::array(names);
}

std::string unit_of_peak(const FrequencyResponses& responses, const FoundPeak& found)
{
  return unit_of(responses.quantity, responses.outputs[found.output], responses.loads[found.load]);
}

/// A measured response and how it agrees with the computed one.
struct Agreement {
  const mbs_export::MeasuredResponse* measured;
  std::string output, load;
  double frac, ratio;
};

std::vector<Agreement> agreements(const FrequencyResponses& responses)
{
  std::vector<Agreement> all;
  for (const mbs_export::MeasuredResponse& one : responses.measured.functions) {
    const Eigen::VectorXcd computed = responses.H[one.load].col(one.output);
    all.push_back({.measured = &one,
                   .output = responses.outputs[static_cast<std::size_t>(one.output)].name,
                   .load = responses.loads[one.load].name,
                   .frac = mbs_export::response_assurance(one.H, computed),
                   .ratio = mbs_export::amplitude_ratio(one.H, computed)});
  }
  return all;
}

Json measured_json(const FrequencyResponses& responses)
{
  std::vector<Json> all;
  for (const Agreement& one : agreements(responses)) {
    all.push_back(Json::object({{"load", one.load},
                                {"output", one.output},
                                {"name", one.measured->name},
                                {"line", one.measured->line},
                                {"frac", one.frac},
                                {"amplitude_ratio", one.ratio}}));
  }
  return Json::array(all);
}

}  // namespace

Peak peak_of(const FrequencyResponses& responses, std::size_t load, Eigen::Index output)
{
  Eigen::Index at = 0;
  const double amplitude = responses.H[load].col(output).cwiseAbs().maxCoeff(&at);
  return {.amplitude = amplitude, .f_Hz = responses.Omega[at] / (2.0 * pi)};
}

TextTable describe(const FrequencyResponses& responses)
{
  TextTable table = quantities();
  table.rows.push_back({"model", name_of(responses.model), ""});
  table.rows.push_back({"quantity", name_of(responses.quantity), ""});
  table.rows.push_back({"damping", responses.damping, ""});
  add(table, "loss factor", responses.loss_factor, "");
  add_count(table, "frequencies", responses.Omega.size());
  add(table, "first frequency", responses.Omega[0] / (2.0 * pi), "Hz");
  add(table, "last frequency", responses.Omega[responses.Omega.size() - 1] / (2.0 * pi), "Hz");
  add_count(table, "loads", std::ssize(responses.loads));
  add_count(table, "outputs", std::ssize(responses.outputs));
  if (!responses.measured.functions.empty())
    add_count(table, "measured responses", std::ssize(responses.measured.functions));
  for (const mbs_export::SectionForceResponses& one : responses.section_forces) {
    add_count(table, "points with section forces of " + one.points.name,
              one.points.positions.rows());
  }
  return table;
}

TextTable list_peaks(const FrequencyResponses& responses)
{
  std::vector<FoundPeak> all = all_peaks(responses);
  const std::size_t n = all.size();
  if (n > most) {
    std::ranges::stable_sort(all, std::ranges::greater{},
                             [](const FoundPeak& found) { return found.peak.amplitude; });
    all.resize(most);
  }
  TextTable table{.header = {"output / load", "largest", "unit", "at, Hz"}, .rows = {}};
  for (const FoundPeak& found : all) {
    table.rows.push_back({printable(fmt::format("{} / {}", responses.outputs[found.output].name,
                                                responses.loads[found.load].name)),
                          fmt::format("{:.6g}", found.peak.amplitude),
                          unit_of_peak(responses, found), fmt::format("{:.6g}", found.peak.f_Hz)});
  }
  if (n > most) table.rows.push_back({fmt::format("and {} more", n - most), "", "", ""});
  return table;
}

TextTable list_measured(const FrequencyResponses& responses)
{
  std::vector<Agreement> all = agreements(responses);
  const std::size_t n = all.size();
  if (n > most) {
    std::ranges::stable_sort(all, {}, &Agreement::frac);
    all.resize(most);
  }
  TextTable table{.header = {"output / load", "measured in line", "FRAC", "computed / measured"},
                  .rows = {}};
  for (const Agreement& one : all) {
    table.rows.push_back({printable(fmt::format("{} / {}", one.output, one.load)),
                          fmt::format("{}", one.measured->line), fmt::format("{:.4f}", one.frac),
                          fmt::format("{:.4g}", one.ratio)});
  }
  if (n > most) table.rows.push_back({fmt::format("and {} more", n - most), "", "", ""});
  return table;
}

std::vector<Json::Member> responses_json(const FrequencyResponses& responses)
{
  std::vector<Json> peaks;
  for (const FoundPeak& found : all_peaks(responses)) {
    peaks.push_back(Json::object({{"load", responses.loads[found.load].name},
                                  {"output", responses.outputs[found.output].name},
                                  {"unit", unit_of_peak(responses, found)},
                                  {"amplitude", found.peak.amplitude},
                                  {"frequency_Hz", found.peak.f_Hz}}));
  }
  const double first = responses.Omega[0], last = responses.Omega[responses.Omega.size() - 1];
  std::vector<Json::Member> members{
      {"model", name_of(responses.model)},
      {"quantity", name_of(responses.quantity)},
      {"damping", responses.damping},
      {"loss_factor", responses.loss_factor},
      {"frequencies_Hz", Json::array({Json(first / (2.0 * pi)), Json(last / (2.0 * pi))})},
      {"n_frequencies", responses.Omega.size()},
      {"loads", names_of(responses.loads)},
      {"outputs", names_of(responses.outputs)},
      {"peaks", Json::array(peaks)}};
  if (!responses.measured.functions.empty()) {
    members.push_back({"measured_file", responses.measured.file});
    members.push_back({"measured", measured_json(responses)});
  }
  return members;
}

TextTable list_assurance(const MeasuredModes& measured, const ModalAssurance& found)
{
  TextTable table{.header = {"measured", "Hz", "mode of the body", "Hz", "difference", "MAC",
                             "MAC of the next"},
                  .rows = {}};
  for (Index k = 0; k < found.mac.rows(); ++k) {
    Index best = 0;
    const double mac = found.mac.row(k).maxCoeff(&best);
    Eigen::RowVectorXd others = found.mac.row(k);
    others[best] = 0.0;
    const double f = found.measured_Hz[k], f_body = found.body_Hz[best];
    const std::string& name = measured.names[static_cast<std::size_t>(k)];
    const bool is_named = !name.empty() && name != "NONE";
    table.rows.push_back({printable(fmt::format("{}{}", k + 1, is_named ? " " + name : "")),
                          fmt::format("{:.4f}", f),
                          fmt::format("{}", found.modes[static_cast<std::size_t>(best)]),
                          fmt::format("{:.4f}", f_body),
                          f > 0.0 ? fmt::format("{:+.2f} %", 100.0 * (f_body / f - 1.0)) : "",
                          fmt::format("{:.4f}", mac), fmt::format("{:.4f}", others.maxCoeff())});
  }
  return table;
}

TextTable describe(const ModalAssurance& found)
{
  TextTable table = quantities();
  add_count(table, "measured nodes", std::ssize(found.nodes));
  add_count(table, "measured components", found.n_components);
  const auto farthest =
      std::ranges::max_element(found.nodes, {}, &mbs_export::MatchedNode::distance);
  add(table, fmt::format("largest distance to a node of the body (node {})", farthest->number),
      farthest->distance, "m");
  return table;
}

std::vector<Json::Member> assurance_json(const ModalAssurance& found)
{
  std::vector<Json> rows, modes, nodes;
  for (Index k = 0; k < found.mac.rows(); ++k)
    rows.push_back(numbers_json(found.mac.row(k).transpose()));
  for (const int mode : found.modes) modes.emplace_back(mode);
  for (const mbs_export::MatchedNode& node : found.nodes) {
    nodes.push_back(Json::object({{"node", node.number},
                                  {"position", numbers_json(node.position)},
                                  {"distance_m", node.distance}}));
  }
  return {{"measured_Hz", numbers_json(found.measured_Hz)},
          {"body_modes", Json::array(modes)},
          {"body_Hz", numbers_json(found.body_Hz)},
          {"mac", Json::array(rows)},
          {"n_components", found.n_components},
          {"nodes", Json::array(nodes)}};
}

}  // namespace chladni::report
