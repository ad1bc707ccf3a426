#include "scene/squeal_tables.hpp"

namespace chladni::scene {
namespace {

using squeal::MapParameter;

/// Whether a brake of this kind has the parameter; the rigid disc has a thickness too.
bool is_of(const squeal::ParameterRow& row, StudyOf of)
{
  using squeal::ParameterOf;
  if (row.of == ParameterOf::any) return true;
  if (of == StudyOf::body) return row.of == ParameterOf::body;
  return row.of != ParameterOf::body || row.name == "thickness";
}

MapParameter read_parameter(const Table& table, std::string_view key, StudyOf of)
{
  const std::string word = table.text(key);
  const std::optional<MapParameter> parameter = squeal::parameter_of(word);
  if (parameter && is_of(*squeal::find_parameter(parameter->name), of)) return *parameter;
  std::vector<std::string> names;
  for (const squeal::ParameterRow& known : squeal::parameters)
    if (is_of(known, of)) names.emplace_back(known.name);
  table.refuse(key, "must be one of " + quoted_list(names) +
                        "; that of one pad alone is called like \"pads[1].stiffness\"");
}

/// Absent: the speed.
std::optional<MapParameter> read_over(const Table& table, StudyOf of)
{
  if (!table.has("over") || table.text("over") == "speed") return std::nullopt;
  return read_parameter(table, "over", of);
}

/// The begin of a range of the parameter.
double read_from(const Table& table, MapParameter parameter)
{
  return squeal::find_parameter(parameter.name)->may_be_zero ? table.number("from")
                                                             : table.number("from", {.above = 0.0});
}

/// Its two ends.
std::optional<squeal::FrequencyBand> read_band(const Table& table)
{
  if (!table.has("band_Hz")) return std::nullopt;
  const std::vector<double> band = table.numbers("band_Hz");
  if (band.size() != 2 || !(band[1] > band[0]))
    table.refuse("band_Hz", "must be the begin and the end of a band, e.g. [1000, 16000]");
  return squeal::FrequencyBand{band[0], band[1]};
}

}  // namespace

std::optional<squeal::DirectCase> read_direct(const Table& squeal,
                                              const std::optional<squeal::TransientCase>& transient)
{
  if (squeal.has("limit_cycle_direct")) {
    const Table table = squeal.table("limit_cycle_direct");
    return squeal::DirectCase{table.number("speed_rad_s")};
  }
  if (transient) return squeal::DirectCase{transient->speed};
  return std::nullopt;
}

squeal::RotationMethod read_rotation_method(const Table& squeal)
{
  using squeal::RotationMethod;
  if (!squeal.has("rotation_stability")) return RotationMethod::hill;
  return squeal.table("rotation_stability")
      .choice<RotationMethod>(
          "method", {{"hill", RotationMethod::hill}, {"floquet", RotationMethod::floquet}});
}

std::vector<squeal::CriticalCase> read_critical(const Table& squeal, StudyOf of)
{
  std::vector<squeal::CriticalCase> searches;
  if (!squeal.has("critical")) return searches;
  for (const Table& table : squeal.tables("critical")) {
    const double from = table.number("from");
    searches.push_back({.parameter = read_parameter(table, "parameter", of),
                        .from = from,
                        .to = table.number("to", {.above = from, .unit = "from"}),
                        .speed = table.number("speed_rad_s")});
  }
  return searches;
}

std::optional<squeal::MapCase> read_map(const Table& squeal, StudyOf of)
{
  if (!squeal.has("map")) return std::nullopt;
  const Table table = squeal.table("map");
  const MapParameter parameter = read_parameter(table, "parameter", of);
  const double from = read_from(table, parameter);
  constexpr int most_points = 10'000'000;
  const int most_values = most_points / squeal.table("speeds").integer("count");
  return squeal::MapCase{.parameter = parameter,
                         .from = from,
                         .to = table.number("to", {.at_least = from}),
                         .count = table.integer("count", {.at_most = double(most_values),
                                                          .unit = "10 million points with the "
                                                                  "speeds"})};
}

std::optional<squeal::StabilityCase> read_stability(const Table& squeal,
                                                    const squeal::SpeedRange& speeds, StudyOf of)
{
  if (!squeal.has("stability")) return std::nullopt;
  const Table table = squeal.table("stability");
  squeal::StabilityCase search{.over = read_over(table, of),
                               .from = speeds.from,
                               .to = speeds.to,
                               .count = speeds.count,
                               .band = read_band(table)};
  if (search.over)
    search.speed = table.number("speed_rad_s");
  else if (table.has("speed_rad_s"))
    table.refuse("speed_rad_s", "is that of a table over another parameter; leave it out");
  if (!search.over && !table.has("from") && !table.has("to") && !table.has("count")) return search;
  search.from = search.over ? read_from(table, *search.over) : table.number("from", {.above = 0.0});
  search.to = table.number("to", {.above = search.from, .unit = "from"});
  search.count = table.integer("count");
  return search;
}

}  // namespace chladni::scene
