#include "report/page/responses.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "report/describe_responses.hpp"
#include "report/page/numbers.hpp"
#include "report/page/page.hpp"
#include "report/version.hpp"

namespace chladni::report {
namespace {

using Eigen::Index;
using mbs_export::FrequencyResponses;

constexpr Index most_curves = 24;  // of each load, to keep the page small

/// The measured response of a load and an output, the first one in the file; none without any.
const mbs_export::MeasuredResponse* measured_of(const FrequencyResponses& responses,
                                                std::size_t load, Index output)
{
  for (const mbs_export::MeasuredResponse& one : responses.measured.functions)
    if (one.load == load && one.output == output) return &one;
  return nullptr;
}

/// The outputs that are drawn for a load, in their order: measured ones, then the largest.
std::vector<Index> drawn(const FrequencyResponses& responses, std::size_t load)
{
  std::vector<Index> outputs(responses.outputs.size());
  std::iota(outputs.begin(), outputs.end(), 0);
  if (std::ssize(outputs) <= most_curves) return outputs;
  std::ranges::stable_sort(outputs, std::ranges::greater{}, [&](Index output) {
    return std::pair(measured_of(responses, load, output) != nullptr,
                     peak_of(responses, load, output).amplitude);
  });
  outputs.resize(most_curves);
  std::ranges::sort(outputs);
  return outputs;
}

std::vector<Json::Member> amplitude_and_phase(const Eigen::VectorXcd& H)
{
  return {{"amplitude", rounded(Eigen::VectorXd(H.cwiseAbs()))},
          {"phase", rounded(Eigen::VectorXd(H.array().arg() * (180.0 / std::numbers::pi)))}};
}

Json curve_json(const FrequencyResponses& responses, std::size_t load, Index output)
{
  const auto& point = responses.outputs[static_cast<std::size_t>(output)];
  std::vector<Json::Member> members = amplitude_and_phase(responses.H[load].col(output));
  members.push_back({"name", point.name});
  members.push_back({"unit", unit_of(responses.quantity, point, responses.loads[load])});
  if (const auto* const measured = measured_of(responses, load, output))
    members.push_back({"measured", Json::object(amplitude_and_phase(measured->H))});
  return Json::object(members);
}

Json load_json(const FrequencyResponses& responses, std::size_t load)
{
  std::vector<Json> curves;
  for (const Index output : drawn(responses, load))
    curves.push_back(curve_json(responses, load, output));
  return Json::object({{"name", responses.loads[load].name},
                       {"curves", Json::array(curves)},
                       {"left_out", responses.outputs.size() - curves.size()}});
}

/// Whether the frequencies multiply from one to the next rather than add.
bool is_logarithmic(const Eigen::VectorXd& Omega)
{
  const Index n = Omega.size();
  return n > 2 && Omega[0] > 0.0 && Omega[n - 1] - Omega[n - 2] > 1.5 * (Omega[1] - Omega[0]);
}

}  // namespace

std::string responses_page(const FrequencyResponses& responses)
{
  std::vector<Json> loads;
  for (std::size_t l = 0; l < responses.loads.size(); ++l) loads.push_back(load_json(responses, l));
  const Json drawing = Json::object(
      {{"quantity", name_of(responses.quantity)},
       {"model", name_of(responses.model)},
       {"logarithmic", is_logarithmic(responses.Omega) ? 1 : 0},
       {"frequency_Hz", rounded(Eigen::VectorXd(responses.Omega / (2.0 * std::numbers::pi)))},
       {"loads", Json::array(loads)}});
  std::vector<Json> tables{table_json("Responses", describe(responses)),
                           table_json("Largest amplitudes", list_peaks(responses))};
  if (!responses.measured.functions.empty())
    tables.push_back(table_json("Measured responses", list_measured(responses)));
  const Json content = Json::object({{"title", responses.title},
                                     {"version", version},
                                     {"responses", drawing},
                                     {"tables", Json::array(tables)},
                                     {"mesh_checksum", responses.provenance.mesh_checksum},
                                     {"scene", responses.provenance.scene}});
  return report_page(responses.title, content, "null");
}

}  // namespace chladni::report
