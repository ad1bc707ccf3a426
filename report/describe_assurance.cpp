#include "report/describe_assurance.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/numbers_json.hpp"
#include "report/quantities.hpp"

namespace chladni::report {

using Eigen::Index;
using mbs_export::MeasuredModes;
using mbs_export::ModalAssurance;

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
