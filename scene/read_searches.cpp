#include "scene/squeal_tables.hpp"

namespace chladni::scene {
namespace {

using squeal::MapParameter;

MapParameter read_parameter(const Table& table)
{
  return table.choice<MapParameter>("parameter", {{"friction", MapParameter::friction},
                                                  {"preload", MapParameter::preload},
                                                  {"stiffness", MapParameter::stiffness}});
}

/// Absent: the speed.
std::optional<MapParameter> read_over(const Table& table)
{
  if (!table.has("over")) return std::nullopt;
  using Over = std::optional<MapParameter>;
  return table.choice<Over>("over", {{"speed", std::nullopt},
                                     {"friction", MapParameter::friction},
                                     {"preload", MapParameter::preload},
                                     {"stiffness", MapParameter::stiffness}});
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

std::vector<squeal::CriticalCase> read_critical(const Table& squeal)
{
  std::vector<squeal::CriticalCase> searches;
  if (!squeal.has("critical")) return searches;
  for (const Table& table : squeal.tables("critical")) {
    const double from = table.number("from");
    searches.push_back({.parameter = read_parameter(table),
                        .from = from,
                        .to = table.number("to", {.above = from, .unit = "from"}),
                        .speed = table.number("speed_rad_s")});
  }
  return searches;
}

std::optional<squeal::MapCase> read_map(const Table& squeal)
{
  if (!squeal.has("map")) return std::nullopt;
  const Table table = squeal.table("map");
  const MapParameter parameter = read_parameter(table);
  const double from = parameter == MapParameter::friction ? table.number("from")
                                                          : table.number("from", {.above = 0.0});
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
                                                    const squeal::SpeedRange& speeds)
{
  if (!squeal.has("stability")) return std::nullopt;
  const Table table = squeal.table("stability");
  squeal::StabilityCase search{.over = read_over(table),
                               .from = speeds.from,
                               .to = speeds.to,
                               .count = speeds.count,
                               .band = read_band(table)};
  if (search.over) {
    search.speed = table.number("speed_rad_s");
  } else if (table.has("speed_rad_s")) {
    table.refuse("speed_rad_s", "is that of a table over another parameter; leave it out");
  }
  if (!search.over && !table.has("from") && !table.has("to") && !table.has("count")) return search;
  search.from = search.over == MapParameter::friction ? table.number("from")
                                                      : table.number("from", {.above = 0.0});
  search.to = table.number("to", {.above = search.from, .unit = "from"});
  search.count = table.integer("count");
  return search;
}

}  // namespace chladni::scene
