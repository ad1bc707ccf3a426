#include <fmt/format.h>

#include <numbers>

#include "scene/keys.hpp"
#include "scene/readers.hpp"
#include "squeal/study_options.hpp"

namespace chladni::scene {

using squeal::IntegratorKind, squeal::MapParameter;

namespace {

std::vector<std::string> names_of_analyses(StudyOf of)
{
  std::vector<std::string> names;
  for (const squeal::Analysis& analysis : squeal::analyses)
    if (of == StudyOf::body || !analysis.needs_body) names.emplace_back(analysis.name);
  return names;
}

/// Each analysis has the key that it needs, or the one that will do.
void check_needs(const Table& squeal, const std::vector<std::string>& asked)
{
  for (const squeal::Analysis& analysis : squeal::analyses) {
    if (!contains(asked, analysis.name) || squeal.has(analysis.key)) continue;
    if (analysis.otherwise.empty()) {
      squeal.refuse("analyses",
                    fmt::format("\"{}\" needs the key {}", analysis.name, analysis.key));
    }
    if (!squeal.has(analysis.otherwise)) {
      squeal.refuse("analyses",
                    fmt::format("\"{}\" needs the key {}, or else the speed in the key {}",
                                analysis.name, analysis.key, analysis.otherwise));
    }
  }
  if (squeal.has("wav") && !squeal.has("transient"))
    squeal.refuse("wav", "needs the key transient");
}

/// squeal.analyses, each of which must be one of `known` and have the key that it needs.
std::vector<std::string> read_analyses(const Table& squeal, const std::vector<std::string>& known)
{
  std::vector<std::string> analyses = squeal.texts("analyses");
  if (analyses.empty())
    squeal.refuse("analyses", "must name at least one of " + quoted_list(known));
  for (std::size_t i = 0; i < analyses.size(); ++i)
    if (!contains(known, analyses[i]))
      squeal.refuse_element("analyses", i, "must be one of " + quoted_list(known));
  check_needs(squeal, analyses);
  return analyses;
}

/// Times rise; the first speed is that at which the transient begins.
std::vector<squeal::SpeedPoint> read_speed_program(const Table& transient, double first_speed)
{
  std::vector<squeal::SpeedPoint> points{{.time = 0.0, .speed = first_speed}};
  for (const Table& row : transient.tables("speed_program")) {
    points.push_back({.time = row.number("t_s", {.above = points.back().time, .unit = "s"}),
                      .speed = row.number("speed_rad_s")});
  }
  if (points.size() == 1) transient.refuse("speed_program", "must hold at least one point");
  return points;
}

/// Times rise; before the first point the preload is that of the first.
std::vector<squeal::PreloadPoint> read_preload_program(const Table& transient)
{
  std::vector<squeal::PreloadPoint> points;
  for (const Table& row : transient.tables("preload_program")) {
    const double time = points.empty()
                            ? row.number("t_s")
                            : row.number("t_s", {.above = points.back().time, .unit = "s"});
    points.push_back({.time = time, .factor = row.number("factor")});
  }
  if (points.empty()) transient.refuse("preload_program", "must hold at least one point");
  return points;
}

/// The keys of one end of the range.
struct SpeedKeys {
  std::string_view rad_s, rpm, km_h;
};

/// In any unit, rad/s.
double read_speed(const Table& speeds, const SpeedKeys& keys, double least)
{
  const std::string_view key = speeds.only_one_of({keys.rad_s, keys.rpm, keys.km_h});
  double unit = 1.0;
  if (key == keys.rpm) unit = std::numbers::pi / 30.0;
  if (key == keys.km_h) unit = 1.0 / (3.6 * speeds.number("wheel_radius"));
  return unit * speeds.number(key, {.at_least = least / unit});
}

/// squeal.speeds
squeal::SpeedRange read_speeds(const Table& squeal)
{
  const Table speeds = squeal.table("speeds");
  const double from = read_speed(speeds, {"from_rad_s", "from_rpm", "from_km_h"}, 0.0);
  const double to = read_speed(speeds, {"to_rad_s", "to_rpm", "to_km_h"}, from);
  const int least = to > from ? 2 : 1;
  return {.from = from,
          .to = to,
          .count = speeds.integer("count", {.at_least = static_cast<double>(least)}),
          .wheel_radius = speeds.has("wheel_radius") ? std::optional(speeds.number("wheel_radius"))
                                                     : std::nullopt};
}

/// squeal.transient
std::optional<squeal::TransientCase> read_transient(const Table& squeal)
{
  if (!squeal.has("transient")) return std::nullopt;
  const Table table = squeal.table("transient");
  squeal::TransientCase transient{
      .speed = table.number("speed_rad_s"),
      .duration = table.number("duration_s"),
      .initial_pad_displacement = table.number("initial_pad_displacement")};
  if (table.has("steps_per_period")) transient.steps_per_period = table.integer("steps_per_period");
  if (table.has("integrator")) {
    transient.integrator = table.choice<IntegratorKind>(
        "integrator", {{"auto", IntegratorKind::automatic},
                       {"splitting", IntegratorKind::splitting},
                       {"exponential", IntegratorKind::exponential},
                       {"dormand-prince", IntegratorKind::dormand_prince},
                       {"generalised-alpha", IntegratorKind::generalised_alpha}});
  }
  if (table.has("growth_error_1_s")) transient.growth_error = table.number("growth_error_1_s");
  if (table.has("speed_program"))
    transient.speed_program = read_speed_program(table, transient.speed);
  if (table.has("preload_program")) transient.preload_program = read_preload_program(table);
  return transient;
}

/// squeal.gradients
std::optional<squeal::GradientCase> read_gradients(const Table& squeal)
{
  if (!squeal.has("gradients")) return std::nullopt;
  return squeal::GradientCase{.speed = squeal.table("gradients").number("speed_rad_s")};
}

/// squeal.growth
std::optional<squeal::GrowthCase> read_growth(const Table& squeal)
{
  if (!squeal.has("growth")) return std::nullopt;
  const Table table = squeal.table("growth");
  squeal::GrowthCase growth{.speeds = table.numbers("speeds_rad_s"),
                            .duration = table.number("duration_s")};
  if (growth.speeds.empty()) table.refuse("speeds_rad_s", "must hold at least one speed");
  return growth;
}

/// squeal.wav
std::optional<squeal::SoundCase> read_sound_case(const Table& squeal)
{
  if (!squeal.has("wav")) return std::nullopt;
  const Table table = squeal.table("wav");
  return squeal::SoundCase{table.integer("rate_Hz")};
}

}  // namespace

squeal::StudyOptions read_study(const Table& squeal, StudyOf of)
{
  squeal::StudyOptions study{.speeds = read_speeds(squeal),
                             .analyses = read_analyses(squeal, names_of_analyses(of)),
                             .transient = read_transient(squeal),
                             .growth = read_growth(squeal)};
  study.limit_cycle_direct = read_direct(squeal, study.transient);
  study.map = read_map(squeal, of);
  study.gradients = read_gradients(squeal);
  study.critical = read_critical(squeal, of);
  study.stability = read_stability(squeal, study.speeds, of);
  if (of == StudyOf::body) study.sound = read_sound_case(squeal);
  return study;
}

namespace {

/// Whether a brake of this kind has the parameter; the rigid disc has a thickness too.
bool is_of_study(const squeal::ParameterRow& row, StudyOf of)
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
  if (parameter && is_of_study(*squeal::find_parameter(parameter->name), of)) return *parameter;
  std::vector<std::string> names;
  for (const squeal::ParameterRow& known : squeal::parameters)
    if (is_of_study(known, of)) names.emplace_back(known.name);
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
