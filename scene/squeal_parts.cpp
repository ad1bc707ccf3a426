#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/squeal_tables.hpp"

namespace chladni::scene {
namespace {

using squeal::ContactLaw;

/// A row of measured friction.
struct MeasuredRow {
  std::optional<double> temperature, pressure;
  squeal::FrictionCurve curve;
};

squeal::FrictionCurve read_curve(const Table& row)
{
  const std::vector<double> mu = row.numbers("mu");
  if (mu.empty()) row.refuse("mu", "must hold at least one coefficient");
  if (!row.has("speed_m_s")) {
    if (mu.size() != 1) row.refuse("mu", "must be one coefficient where the row has no speed_m_s");
    return squeal::friction_curve({0.0}, mu);
  }
  const std::vector<double> speeds = row.numbers("speed_m_s");
  for (std::size_t i = 1; i < speeds.size(); ++i)
    if (speeds[i] <= speeds[i - 1])
      row.refuse_element("speed_m_s", i, "must be larger than the one before");
  if (speeds.size() < 2) row.refuse("speed_m_s", "must hold at least two speeds");
  if (mu.size() != speeds.size()) row.refuse("mu", "must be as many as the numbers of speed_m_s");
  return squeal::friction_curve(speeds, mu);
}

MeasuredRow read_row(const Table& row)
{
  MeasuredRow measured{.temperature = {}, .pressure = {}, .curve = read_curve(row)};
  if (row.has("temperature_C")) measured.temperature = row.number("temperature_C");
  if (row.has("pressure_Pa")) measured.pressure = row.number("pressure_Pa");
  return measured;
}

/// The values that rows have of a key, ascending, each once; empty where no row has it.
std::vector<double> axis_of(const std::vector<MeasuredRow>& rows,
                            std::optional<double> MeasuredRow::*key)
{
  std::vector<double> values;
  for (const MeasuredRow& row : rows)
    if (row.*key) values.push_back(*(row.*key));
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// All rows have a key, or none.
void check_key(const std::vector<Table>& tables, const char* key)
{
  for (const Table& row : tables)
    if (row.has(key) != tables.front().has(key))
      tables.front().refuse("mu", std::string("all rows of the table need ") + key + ", or none");
}

/// A curve at each pressure of each temperature.
squeal::FrictionTable table_of(const Table& friction, const std::vector<MeasuredRow>& rows)
{
  squeal::FrictionTable table{.temperatures = axis_of(rows, &MeasuredRow::temperature),
                              .pressures = axis_of(rows, &MeasuredRow::pressure),
                              .curves = {}};
  const std::size_t n_T = std::max<std::size_t>(1, table.temperatures.size());
  const std::size_t n_p = std::max<std::size_t>(1, table.pressures.size());
  for (std::size_t i = 0; i < n_T * n_p; ++i) {
    const auto is_meant = [&](const MeasuredRow& row) {
      return (!row.temperature || *row.temperature == table.temperatures[i / n_p]) &&
             (!row.pressure || *row.pressure == table.pressures[i % n_p]);
    };
    if (std::ranges::count_if(rows, is_meant) != 1) {
      const auto said = [&](const std::vector<double>& axis, std::size_t at, const char* unit) {
        return axis.empty() ? std::string() : fmt::format(" {:.6g} {}", axis[at], unit);
      };
      friction.refuse(
          "table",
          fmt::format("must have one row for each temperature with each pressure; of{}{} "
                      "it has {}",
                      said(table.temperatures, i / n_p, "degrees Celsius"),
                      said(table.pressures, i % n_p, "Pa"), std::ranges::count_if(rows, is_meant)));
    }
    table.curves.push_back(std::ranges::find_if(rows, is_meant)->curve);
  }
  return table;
}

double read_temperature(const Table& friction, const squeal::FrictionTable& table)
{
  if (table.temperatures.empty()) {
    if (friction.has("temperature_C"))
      friction.refuse("temperature_C", "the rows of the table have no temperature_C");
    return 20.0;
  }
  return friction.number("temperature_C", {.at_least = table.temperatures.front(),
                                           .at_most = table.temperatures.back(),
                                           .unit = "degrees Celsius, those of the table"});
}

/// Measured friction: mu = factor table(v, p) at a temperature.
squeal::FrictionLaw read_measured(const Table& friction)
{
  for (const char* key : {"kinetic", "static", "decay_speed"})
    if (friction.has(key)) friction.refuse(key, "`table` replaces this key; take this key out");
  const std::vector<Table> tables = friction.tables("table");
  if (tables.empty()) friction.refuse("table", "must hold at least one row");
  for (const char* key : {"temperature_C", "pressure_Pa"}) check_key(tables, key);
  std::vector<MeasuredRow> rows;
  for (const Table& row : tables) {
    rows.push_back(read_row(row));
    rows.back().curve.row = static_cast<int>(rows.size());
  }
  const squeal::FrictionTable table = table_of(friction, rows);
  squeal::FrictionLaw law{.kinetic = friction.has("factor") ? friction.number("factor") : 1.0};
  if (friction.has("regularisation")) law.regularisation = friction.number("regularisation");
  law.temperature = read_temperature(friction, table);
  law.table = std::make_shared<const squeal::FrictionTable>(table);
  return law;
}

}  // namespace

squeal::FrictionLaw read_friction(const Table& of)
{
  if (!of.is_table("friction")) return {.kinetic = of.number("friction")};
  const Table table = of.table("friction");
  if (table.has("table")) return read_measured(table);
  squeal::FrictionLaw law{.kinetic = table.number("kinetic")};
  if (table.has("static")) {
    law.rise = table.number("static") - law.kinetic;
    law.decay_speed = table.number("decay_speed");
  }
  if (table.has("regularisation")) law.regularisation = table.number("regularisation");
  return law;
}

squeal::FrictionLaw read_plain_friction(const Table& squeal)
{
  if (squeal.is_table("friction") && squeal.table("friction").has("table")) {
    squeal.table("friction")
        .refuse("table", "is for a flexible disc; give this model kinetic, static and decay_speed");
  }
  return read_friction(squeal);
}

squeal::ContactLaw read_contact(const Table& squeal)
{
  if (!squeal.has("contact")) return ContactLaw::unilateral;
  return squeal.choice<ContactLaw>("contact", {{"unilateral", ContactLaw::unilateral},
                                               {"bilateral", ContactLaw::bilateral},
                                               {"signed", ContactLaw::signed_force}});
}

squeal::PadSpring read_pad_spring(const Table& pad)
{
  squeal::PadSpring spring{.linear = pad.number("stiffness")};
  if (pad.has("cubic_stiffness")) spring.cubic = pad.number("cubic_stiffness");
  return spring;
}

}  // namespace chladni::scene
