#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numbers>

#include "cli/scene/read_tables.hpp"

namespace chladni::cli {
namespace {

using squeal::ContactLaw;
using squeal::IntegratorKind;
using squeal::MapParameter;

const std::vector<std::string> analysis_names = {
    "eigenvalues",        "critical-speed",     "growth",       "transient", "limit-cycle",
    "limit-cycle-direct", "limit-cycle-branch", "stability-map"};

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

squeal::SpeedRange read_speeds(const Table& squeal)
{
  const Table speeds = squeal.table("speeds");
  const double from = speeds.number("from_rad_s", {.above = 0.0, .unit = "rad/s"});
  const double to = speeds.number("to_rad_s", {.at_least = from, .unit = "rad/s, from_rad_s"});
  const int least = to > from ? 2 : 1;
  return {.from = from,
          .to = to,
          .count = speeds.integer("count", {.at_least = static_cast<double>(least)})};
}

squeal::PadPair read_pad(const Table& pad)
{
  constexpr double degree = std::numbers::pi / 180.0;
  return {.angle = degree * pad.number("angle_deg", {.unit = "degrees"}),
          .stiffness = pad.number("stiffness", {.above = 0.0, .unit = "N/m"}),
          .damping = pad.number("damping", {.at_least = 0.0, .unit = "N s/m"}),
          .preload = pad.number("preload", {.at_least = 0.0, .unit = "N"})};
}

std::vector<squeal::PadPair> read_pads(const Table& squeal)
{
  std::vector<squeal::PadPair> pads;
  for (const Table& pad : squeal.tables("pads")) pads.push_back(read_pad(pad));
  if (pads.empty()) squeal.refuse("pads", "must hold at least one pad pair");
  return pads;
}

std::vector<std::string> read_analyses(const Table& squeal)
{
  std::vector<std::string> analyses = squeal.texts("analyses");
  if (analyses.empty()) {
    squeal.refuse("analyses", "must name at least one of " + quoted_list(analysis_names));
  }
  for (std::size_t i = 0; i < analyses.size(); ++i) {
    if (!contains(analysis_names, analyses[i])) {
      squeal.refuse_element("analyses", i, "must be one of " + quoted_list(analysis_names));
    }
  }
  // The limit cycle is looked for at the speed of the transient.
  if (contains(analyses, "limit-cycle") && !squeal.has("transient")) {
    squeal.refuse("analyses", "\"limit-cycle\" needs the speed in the key transient");
  }
  if (contains(analyses, "limit-cycle-direct") && !squeal.has("limit_cycle_direct") &&
      !squeal.has("transient")) {
    squeal.refuse("analyses",
                  "\"limit-cycle-direct\" needs the key limit_cycle_direct, or else the speed in "
                  "the key transient");
  }
  if (contains(analyses, "stability-map") && !squeal.has("map")) {
    squeal.refuse("analyses", "\"stability-map\" needs the key map");
  }
  for (const char* needed : {"transient", "growth"}) {
    if (contains(analyses, needed) && !squeal.has(needed)) {
      squeal.refuse("analyses", fmt::format("\"{0}\" needs the key {0}", needed));
    }
  }
  return analyses;
}

std::optional<squeal::TransientCase> read_transient(const Table& squeal)
{
  if (!squeal.has("transient")) return std::nullopt;
  const Table table = squeal.table("transient");
  squeal::TransientCase transient{
      .speed = table.number("speed_rad_s", {.above = 0.0, .unit = "rad/s"}),
      .duration = table.number("duration_s", {.above = 0.0, .unit = "s"}),
      .initial_pad_displacement =
          table.number("initial_pad_displacement", {.above = 0.0, .unit = "m"})};
  if (table.has("steps_per_period")) {
    transient.steps_per_period = table.integer("steps_per_period", {.at_least = 8});
  }
  if (table.has("integrator")) {
    transient.integrator = table.choice<IntegratorKind>(
        "integrator", {{"auto", IntegratorKind::automatic},
                       {"splitting", IntegratorKind::splitting},
                       {"exponential", IntegratorKind::exponential},
                       {"dormand-prince", IntegratorKind::dormand_prince},
                       {"generalised-alpha", IntegratorKind::generalised_alpha}});
  }
  if (table.has("growth_error_1_s")) {
    transient.growth_error = table.number("growth_error_1_s", {.above = 0.0, .unit = "1/s"});
  }
  return transient;
}

std::optional<squeal::GrowthCase> read_growth(const Table& squeal)
{
  if (!squeal.has("growth")) return std::nullopt;
  const Table table = squeal.table("growth");
  squeal::GrowthCase growth{
      .speeds = table.numbers("speeds_rad_s", {.above = 0.0, .unit = "rad/s"}),
      .duration = table.number("duration_s", {.above = 0.0, .unit = "s"})};
  if (growth.speeds.empty()) table.refuse("speeds_rad_s", "must hold at least one speed");
  return growth;
}

/// At the speed of the transient unless the scene gives another one.
std::optional<squeal::DirectCase> read_direct(const Table& squeal,
                                              const std::optional<squeal::TransientCase>& transient)
{
  if (squeal.has("limit_cycle_direct")) {
    const Table table = squeal.table("limit_cycle_direct");
    return squeal::DirectCase{table.number("speed_rad_s", {.above = 0.0, .unit = "rad/s"})};
  }
  if (transient) return squeal::DirectCase{transient->speed};
  return std::nullopt;
}

std::optional<squeal::MapCase> read_map(const Table& squeal)
{
  if (!squeal.has("map")) return std::nullopt;
  const Table table = squeal.table("map");
  const auto parameter =
      table.choice<MapParameter>("parameter", {{"friction", MapParameter::friction},
                                               {"preload", MapParameter::preload},
                                               {"stiffness", MapParameter::stiffness}});
  const double from = parameter == MapParameter::friction ? table.number("from", {.at_least = 0.0})
                                                          : table.number("from", {.above = 0.0});
  return squeal::MapCase{.parameter = parameter,
                         .from = from,
                         .to = table.number("to", {.at_least = from}),
                         .count = table.integer("count", {.at_least = 1.0})};
}

}  // namespace

std::optional<squeal::SquealOptions> read_squeal(const Table& root, const Scene& scene)
{
  if (!root.has("squeal")) return std::nullopt;
  const Table squeal = root.table("squeal");
  squeal::SquealOptions options{};
  options.ring = read_ring(squeal, scene);
  options.thickness = squeal.number("thickness", {.above = 0.0, .unit = "m"});
  options.modes = read_modes(squeal);
  options.speeds = read_speeds(squeal);
  options.friction = squeal.number("friction", {.at_least = 0.0});
  if (squeal.has("contact")) {
    options.contact = squeal.choice<ContactLaw>("contact", {{"unilateral", ContactLaw::unilateral},
                                                            {"bilateral", ContactLaw::bilateral},
                                                            {"signed", ContactLaw::signed_force}});
  }
  options.pads = read_pads(squeal);
  options.analyses = read_analyses(squeal);
  options.transient = read_transient(squeal);
  options.growth = read_growth(squeal);
  options.limit_cycle_direct = read_direct(squeal, options.transient);
  options.map = read_map(squeal);
  return options;
}

}  // namespace chladni::cli
