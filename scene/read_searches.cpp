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

}  // namespace chladni::scene
