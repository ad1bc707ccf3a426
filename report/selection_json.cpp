#include "report/selection_json.hpp"

#include <numbers>

namespace chladni::report {
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
