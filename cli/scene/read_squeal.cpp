#include <fmt/format.h>

#include <charconv>

#include "cli/scene/read_tables.hpp"
#include "cli/scene/squeal_tables.hpp"

namespace chladni::cli {
namespace {

using squeal::MapParameter;

const std::vector<std::string> analysis_names = {
    "eigenvalues",        "critical-speed",     "growth",        "transient",       "limit-cycle",
    "limit-cycle-direct", "limit-cycle-branch", "stability-map", "critical-values", "spectrum",
    "mode-sensitivity"};

std::string read_ring(const Table& squeal, const Scene& scene)
{
  const std::string ring = squeal.text("ring");
  const std::vector<std::string> rings = ring_names(scene.mesh);
  if (!contains(rings, ring)) squeal.refuse("ring", no_such_name("ring", ring, rings));
  if (!contains(scene.interface_nodes, ring)) {
    squeal.refuse("ring", "must stand in interface.nodes too, or the body does not have it");
  }
  return ring;
}

/// The n of "nodal-diameters n"; absent when the text is anything else.
std::optional<int> nodal_diameters(const std::string& text)
{
  constexpr std::string_view prefix = "nodal-diameters ";
  if (!text.starts_with(prefix)) return std::nullopt;
  int n = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + prefix.size(), end, n);
  if (error != std::errc{} || rest != end || n < 1) return std::nullopt;
  return n;
}

squeal::ModeChoice read_modes(const Table& squeal)
{
  squeal::ModeChoice modes;
  if (!squeal.has("use_modes")) return modes;
  if (squeal.is_list("use_modes")) {
    modes.list = read_mode_list(squeal, "use_modes");
    return modes;
  }
  const std::string text = squeal.text("use_modes");
  modes.nodal_diameters = nodal_diameters(text);
  if (text != "all" && !modes.nodal_diameters) {
    squeal.refuse("use_modes",
                  "must be \"all\", \"nodal-diameters N\" with N >= 1, or a list of mode numbers");
  }
  return modes;
}

/// At the speed of the transient unless the scene gives another one.
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

MapParameter read_parameter(const Table& table)
{
  return table.choice<MapParameter>("parameter", {{"friction", MapParameter::friction},
                                                  {"preload", MapParameter::preload},
                                                  {"stiffness", MapParameter::stiffness}});
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

std::optional<squeal::SoundCase> read_sound(const Table& squeal)
{
  if (!squeal.has("wav")) return std::nullopt;
  const Table table = squeal.table("wav");
  return squeal::SoundCase{table.integer("rate_Hz")};
}

std::optional<squeal::MapCase> read_map(const Table& squeal)
{
  if (!squeal.has("map")) return std::nullopt;
  const Table table = squeal.table("map");
  const MapParameter parameter = read_parameter(table);
  const double from = parameter == MapParameter::friction ? table.number("from")
                                                          : table.number("from", {.above = 0.0});
  return squeal::MapCase{.parameter = parameter,
                         .from = from,
                         .to = table.number("to", {.at_least = from}),
                         .count = table.integer("count")};
}

}  // namespace

std::optional<squeal::SquealOptions> read_squeal(const Table& root, const Scene& scene)
{
  if (!root.has("squeal")) return std::nullopt;
  const Table squeal = root.table("squeal");
  squeal::SquealOptions options{};
  options.ring = read_ring(squeal, scene);
  options.thickness = squeal.number("thickness");
  options.modes = read_modes(squeal);
  options.speeds = read_speeds(squeal);
  const squeal::FrictionLaw friction = read_friction(squeal);
  options.friction = friction.kinetic;
  options.friction_rise = friction.rise;
  options.friction_decay_speed = friction.decay_speed;
  options.slip_regularisation = friction.regularisation;
  options.contact = read_contact(squeal);
  options.pads = read_pads(squeal);
  options.analyses = read_analyses(squeal, analysis_names);
  options.transient = read_transient(squeal);
  options.growth = read_growth(squeal);
  options.limit_cycle_direct = read_direct(squeal, options.transient);
  options.map = read_map(squeal);
  options.critical = read_critical(squeal);
  options.sound = read_sound(squeal);
  return options;
}

}  // namespace chladni::cli
