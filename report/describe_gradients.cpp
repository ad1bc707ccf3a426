#include "report/describe_gradients.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "report/numbers_json.hpp"
#include "report/quantities.hpp"

namespace chladni::report {
namespace {

constexpr std::size_t rows_told = 20;

/// "+0.012" of the usual change
std::string effect(const squeal::GradientRow& row, double derivative)
{
  const double change = squeal::usual_change(row).value * derivative;
  return change == 0.0 ? "0" : fmt::format("{:+.3g}", change);
}

}  // namespace

TextTable gradients_table(const squeal::Gradients& gradients)
{
  TextTable table{.header = {"number raised by 1 %", "value", "unit"}, .rows = {}};
  if (gradients.critical_speed) table.header.emplace_back("critical speed, rad/s");
  for (const squeal::GradientMotion& motion : gradients.motions)
    table.header.push_back(fmt::format("growth at {:.5g} Hz, 1/s", motion.frequency_Hz));
  for (const squeal::GradientRow& row : gradients.rows) {
    const std::string change = squeal::usual_change(row).name;
    std::vector<std::string> cells{
        change == "1 %" ? row.key : fmt::format("{} (by +{})", row.key, change),
        fmt::format("{:.6g}", row.value), row.unit};
    if (gradients.critical_speed) cells.push_back(effect(row, row.critical_speed.value_or(0.0)));
    for (const double growth : row.growth) cells.push_back(effect(row, growth));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

void add_gradients(TextTable& table, const squeal::Gradients& gradients)
{
  const bool of_speed = gradients.critical_speed.has_value();
  if (of_speed) add(table, "critical speed (gradients)", *gradients.critical_speed, "rad/s");
  if (gradients.speed && !gradients.motions.empty()) {
    add(table, fmt::format("largest growth at {:.6g} rad/s (gradients)", *gradients.speed),
        gradients.motions.front().growth, "1/s");
  }
  for (std::size_t i = 0; i < std::min(rows_told, gradients.rows.size()); ++i) {
    const squeal::GradientRow& row = gradients.rows[i];
    const double derivative = of_speed                ? row.critical_speed.value_or(0.0)
                              : row.growth.size() > 0 ? row.growth[0]
                                                      : 0.0;
    add(table,
        fmt::format("+{} of {} moves the {} by", squeal::usual_change(row).name, row.key,
                    of_speed ? "critical speed" : "largest growth"),
        squeal::usual_change(row).value * derivative, of_speed ? "rad/s" : "1/s");
  }
}

Json gradients_json(const squeal::Gradients& gradients)
{
  std::vector<Json> motions, rows;
  for (const squeal::GradientMotion& motion : gradients.motions) {
    motions.push_back(
        Json::object({{"growth_1_s", motion.growth}, {"frequency_Hz", motion.frequency_Hz}}));
  }
  for (const squeal::GradientRow& row : gradients.rows) {
    std::vector<Json> growth(row.growth.begin(), row.growth.end());
    rows.push_back(Json::object({{"key", row.key},
                                 {"unit", row.unit},
                                 {"value", row.value},
                                 {"critical_speed_by_value", optional_json(row.critical_speed)},
                                 {"growth_by_value", Json::array(growth)}}));
  }
  return Json::object({{"critical_speed_rad_s", optional_json(gradients.critical_speed)},
                       {"critical_frequency_Hz", optional_json(gradients.critical_frequency_Hz)},
                       {"speed_rad_s", optional_json(gradients.speed)},
                       {"motions", Json::array(motions)},
                       {"rows", Json::array(rows)}});
}

}  // namespace chladni::report
