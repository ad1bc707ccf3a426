#include "report/fe/sound_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numbers>
#include <optional>

#include "report/text_table.hpp"

namespace chladni::report {
namespace {

using std::numbers::pi;

/// Below this only round-off sounds: 2e-10 Pa, 1e-5 of the threshold of hearing.
constexpr double silence_dB = -100.0;

std::string level_text(double dB)
{
  return dB < silence_dB ? "silent" : fmt::format("{:.2f}", dB);
}

std::string tones_table(const sound::SoundResults& results)
{
  const auto estimate = [](const std::optional<double>& error) {
    return error ? fmt::format("{:.1e}", *error) : std::string("unknown");
  };
  TextTable table{.header = {"tone, Hz", "unknowns", "power, W", "its error", "error of pressure"},
                  .rows = {}};
  for (std::size_t i = 0; i < results.tones.size(); ++i) {
    const sound::Tone& tone = results.tones[i];
    const sound::Accuracy& accuracy = results.accuracy[i];
    table.rows.push_back({fmt::format("{:.2f}", tone.omega / (2.0 * pi)),
                          fmt::format("{}", tone.n_unknowns),
                          fmt::format("{:.4g}", near_power(tone)), estimate(accuracy.power()),
                          estimate(accuracy.pressure)});
  }
  return format_table(table);
}

std::string microphones_table(const sound::SoundResults& results)
{
  TextTable table{.header = {"microphone", "dB", "dB(A)", "dB of the peak", "amplitude, Pa",
                             "around the axis, Pa"},
                  .rows = {}};
  for (std::size_t i = 0; i < results.heard.size(); ++i) {
    const sound::Heard& heard = results.heard[i];
    table.rows.push_back({results.microphones[i].name, level_text(heard.rms_dB),
                          level_text(heard.A_dB), level_text(heard.peak_dB),
                          fmt::format("{:.4g}", heard.peak),
                          fmt::format("{:.4g} to {:.4g}", std::numbers::sqrt2 * heard.least,
                                      std::numbers::sqrt2 * heard.largest)});
  }
  return format_table(table);
}

std::string radiation_table(const squeal::Radiation& radiation)
{
  TextTable table{
      .header = {"mode", "Hz", "at, Hz", "decay by its sound, 1/s", "damping ratio", "added mass"},
      .rows = {}};
  for (Eigen::Index i = 0; i < radiation.omega.size(); ++i) {
    table.rows.push_back({fmt::format("{}", radiation.mode_numbers[std::size_t(i)]),
                          fmt::format("{:.3f}", radiation.omega[i] / (2.0 * pi)),
                          fmt::format("{:.3f}", radiation.at[i] / (2.0 * pi)),
                          fmt::format("{:.4f}", 0.5 * radiation.damping[i]),
                          fmt::format("{:.3e}", 0.5 * radiation.damping[i] / radiation.omega[i]),
                          fmt::format("{:.2e}", radiation.added_mass[i])});
  }
  return format_table(table);
}

std::vector<std::string> brake_row(const std::string& name, const sound::Brake& brake)
{
  return {name,
          brake.critical ? fmt::format("{:.4f} pi", brake.critical->speed / pi)
                         : "none: " + brake.stability,
          fmt::format("{:.4f}", brake.growth),
          brake.cycle ? fmt::format("{:.3f}", brake.cycle->frequency_Hz) : "-",
          brake.cycle ? fmt::format("{:.4g}", brake.cycle->pad_velocity) : "-"};
}

std::string feedback_table(const sound::Feedback& feedback)
{
  return format_table(
      {.header = {fmt::format("at {:.4g} rad/s", feedback.speed), "critical speed, rad/s",
                  "growth, 1/s", "limit cycle, Hz", "pad velocity, m/s"},
       .rows = {brake_row("without radiation", feedback.without),
                brake_row("with radiation", feedback.with)}});
}

std::string loudness_table(const sound::SoundResults& results)
{
  TextTable table{.header = {"speed, rad/s", "radiation", "Hz", "pad, m/s", "power, W"},
                  .rows = {}};
  for (const sound::Microphone& microphone : results.microphones)
    table.header.push_back(microphone.name + ", dB");
  for (const sound::Loudness& at : results.loudness) {
    std::vector<std::string> row = {fmt::format("{:.4f} pi", at.speed / pi),
                                    at.damped ? "with" : "without"};
    const bool sounds = at.frequency_Hz > 0.0;
    row.push_back(sounds ? fmt::format("{:.2f}", at.frequency_Hz) : "stable");
    row.push_back(sounds ? fmt::format("{:.4g}", at.pad_velocity) : "");
    row.push_back(sounds ? fmt::format("{:.4g}", at.power) : "");
    for (std::size_t i = 0; i < results.microphones.size(); ++i)
      row.push_back(sounds ? level_text(at.rms_dB[i]) : "");
    table.rows.push_back(row);
  }
  return format_table(table);
}

Json tones_json(const sound::SoundResults& results)
{
  const auto estimate = [](const std::optional<double>& error) {
    return error ? Json(*error) : Json();
  };
  std::vector<Json> all;
  for (std::size_t i = 0; i < results.tones.size(); ++i) {
    const sound::Tone& tone = results.tones[i];
    const sound::Accuracy& accuracy = results.accuracy[i];
    const double power = near_power(tone);
    all.push_back(Json::object({{"harmonic", tone.h},
                                {"frequency_Hz", tone.omega / (2.0 * pi)},
                                {"unknowns", tone.n_unknowns},
                                {"power_W", power},
                                {"far_power_W", power * (1.0 + accuracy.balance)},
                                {"power_error", estimate(accuracy.power())},
                                {"pressure_error", estimate(accuracy.pressure)}}));
  }
  return Json::array(all);
}

Json microphones_json(const sound::SoundResults& results)
{
  std::vector<Json> all;
  for (std::size_t i = 0; i < results.heard.size(); ++i) {
    const sound::Heard& heard = results.heard[i];
    std::vector<Json> pressure;
    for (const std::complex<double>& p : heard.pressure)
      pressure.push_back(Json::array({p.real(), p.imag()}));
    all.push_back(Json::object({{"name", results.microphones[i].name},
                                {"pressure_Pa", Json::array(pressure)},
                                {"level_dB", heard.rms_dB},
                                {"level_A_dB", heard.A_dB},
                                {"level_of_peak_dB", heard.peak_dB},
                                {"least_rms_around_axis_Pa", heard.least},
                                {"largest_rms_around_axis_Pa", heard.largest}}));
  }
  return Json::array(all);
}

Json radiation_json(const squeal::Radiation& radiation)
{
  std::vector<Json> all;
  for (Eigen::Index i = 0; i < radiation.omega.size(); ++i) {
    all.push_back(Json::object({{"mode", radiation.mode_numbers[std::size_t(i)]},
                                {"frequency_Hz", radiation.omega[i] / (2.0 * pi)},
                                {"evaluated_at_Hz", radiation.at[i] / (2.0 * pi)},
                                {"decay_1_s", 0.5 * radiation.damping[i]},
                                {"added_mass", radiation.added_mass[i]}}));
  }
  return Json::array(all);
}

Json brake_json(const sound::Brake& brake)
{
  const auto& cycle = brake.cycle;
  return Json::object(
      {{"critical_speed_rad_s", brake.critical ? Json(brake.critical->speed) : Json()},
       {"stability", brake.stability},
       {"growth_1_s", brake.growth},
       {"frequency_Hz", cycle ? Json(cycle->frequency_Hz) : Json()},
       {"pad_velocity_m_s", cycle ? Json(cycle->pad_velocity) : Json()}});
}

Json loudness_json(const std::vector<sound::Loudness>& loudness)
{
  std::vector<Json> all;
  for (const sound::Loudness& at : loudness) {
    const std::vector<Json> levels(at.rms_dB.begin(), at.rms_dB.end());
    all.push_back(Json::object({{"speed_rad_s", at.speed},
                                {"radiation", at.damped ? "with" : "without"},
                                {"frequency_Hz", at.frequency_Hz},
                                {"pad_velocity_m_s", at.pad_velocity},
                                {"power_W", at.power},
                                {"level_dB", Json::array(levels)}}));
  }
  return Json::array(all);
}

}  // namespace

std::string describe_sound(const sound::SoundResults& results)
{
  std::vector<std::string> tables;
  if (!results.tones.empty()) tables.push_back(tones_table(results));
  if (!results.heard.empty()) tables.push_back(microphones_table(results));
  tables.push_back(radiation_table(results.radiation));
  if (results.feedback) tables.push_back(feedback_table(*results.feedback));
  if (!results.loudness.empty()) tables.push_back(loudness_table(results));
  tables.push_back(fmt::format(
      "motion of the surface that splines and harmonics leave out: {:.1e}\n", results.residual));
  for (const std::string& note : results.notes) tables.back() += note + "\n";
  return fmt::format("{}", fmt::join(tables, "\n"));
}

std::vector<Json::Member> sound_json(const sound::SoundResults& results)
{
  double power = 0.0;
  for (const sound::Tone& tone : results.tones) power += near_power(tone);
  std::vector<Json::Member> members = {{"power_W", power},
                                       {"tones", tones_json(results)},
                                       {"microphones", microphones_json(results)},
                                       {"radiation", radiation_json(results.radiation)},
                                       {"surface_residual", results.residual}};
  if (results.feedback) {
    members.emplace_back("feedback",
                         Json::object({{"speed_rad_s", results.feedback->speed},
                                       {"without_radiation", brake_json(results.feedback->without)},
                                       {"with_radiation", brake_json(results.feedback->with)}}));
  }
  if (!results.loudness.empty()) members.emplace_back("loudness", loudness_json(results.loudness));
  if (!results.notes.empty())
    members.emplace_back("notes", Json::array({results.notes.begin(), results.notes.end()}));
  return members;
}

}  // namespace chladni::report
