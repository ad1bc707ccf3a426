#include "squeal/results/transient_results.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "mbs_export/files/body_files.hpp"
#include "squeal/results/file_checks.hpp"

namespace chladni::squeal {

using files::Reader, files::Writer;

namespace {

std::vector<double> read_series(const Reader& file, const std::string& name, Eigen::Index size = -1)
{
  const Eigen::VectorXd x = file.vector(name, size);
  return {x.begin(), x.end()};
}

void write_history(Writer& file, const std::string& group, const History& history)
{
  file.write(group + "/t", history.t, "s");
  file.write(group + "/pad_velocity", history.pad_velocity, "m/s");
  file.write(group + "/pad_displacement", history.pad_displacement, "m");
  file.write(group + "/N_up", history.N_up, "N");
  file.write(group + "/N_lo", history.N_lo, "N");
  file.write(group + "/slip_speed", history.slip_speed, "m/s");
}

History read_history(const Reader& file, const std::string& group)
{
  const std::vector<double> t = read_times(file, group + "/t");
  const auto n = static_cast<Eigen::Index>(t.size());
  return {t,
          read_series(file, group + "/pad_velocity", n),
          read_series(file, group + "/pad_displacement", n),
          read_series(file, group + "/N_up", n),
          read_series(file, group + "/N_lo", n),
          read_series(file, group + "/slip_speed", n)};
}

constexpr auto whole = "every sample", band_limited = "band-limited";

/// For whoever looks at the file alone, in words too.
void write_band(Writer& file, const Band& band)
{
  const bool is_whole = band.sampling == Sampling::whole;
  file.write("transient/history/sampling", is_whole ? whole : band_limited);
  file.write("transient/history/rate", band.rate_Hz, "Hz");
  file.write("transient/history/band", band.to_Hz, "Hz");
  file.attribute("transient/history", "sampling", spoken(band));
}

Band read_band(const Reader& file)
{
  if (!file.contains("transient/history/sampling")) return {};
  const std::string sampling = file.text("transient/history/sampling");
  if (sampling != whole && sampling != band_limited) {
    file.fail("transient/history/sampling",
              fmt::format("is \"{}\"; expected \"{}\" or \"{}\"", sampling, whole, band_limited));
  }
  return {sampling == whole ? Sampling::whole : Sampling::band_limited,
          file.real("transient/history/rate"), file.real("transient/history/band")};
}

/// The series of the windows but for their times, with their units.
struct WindowSeries {
  const char* name;
  const char* unit;
  std::vector<double> Windows::*values;
};
constexpr std::array<WindowSeries, 7> window_series = {{
    {"speed", "rad/s", &Windows::speed},
    {"N_up_min", "N", &Windows::N_up_min},
    {"N_up_max", "N", &Windows::N_up_max},
    {"N_lo_min", "N", &Windows::N_lo_min},
    {"N_lo_max", "N", &Windows::N_lo_max},
    {"slip_speed_min", "m/s", &Windows::slip_speed_min},
    {"open", "1", &Windows::open},
}};

void write_windows(Writer& file, const Windows& windows)
{
  file.write("transient/windows/t", windows.t, "s");
  for (const WindowSeries& series : window_series) {
    file.write(fmt::format("transient/windows/{}", series.name), windows.*series.values,
               series.unit);
  }
}

Windows read_windows(const Reader& file)
{
  Windows windows;
  if (!file.contains("transient/windows/t")) return windows;
  windows.t = read_times(file, "transient/windows/t");
  for (const WindowSeries& series : window_series) {
    windows.*series.values = read_series(file, fmt::format("transient/windows/{}", series.name),
                                         static_cast<Eigen::Index>(windows.t.size()));
  }
  return windows;
}

void write_events(Writer& file, const Transient& run)
{
  std::vector<double> t;
  std::vector<int> pads, gains;
  for (const ContactEvent& event : run.events) {
    t.push_back(event.t);
    pads.push_back(event.pad);
    gains.push_back(event.gains ? 1 : 0);
  }
  file.write("transient/events/t", t, "s");
  file.write("transient/events/pad", std::span<const int>(pads), "1");
  file.write("transient/events/gains", std::span<const int>(gains), "1");
  file.write("transient/events/count", run.n_events, "1");
}

std::vector<ContactEvent> read_events(const Reader& file)
{
  const std::vector<double> t = read_times(file, "transient/events/t");
  const auto n = static_cast<Eigen::Index>(t.size());
  constexpr Eigen::Index limit = std::numeric_limits<int>::max();
  const auto pads = mbs_export::file_parts::read_indices(file, "transient/events/pad", limit, n);
  const auto gains = file.integers("transient/events/gains", n);
  std::vector<ContactEvent> events;
  for (std::size_t i = 0; i < t.size(); ++i) events.push_back({t[i], pads[i], gains[i] != 0});
  return events;
}

}  // namespace

std::string spoken(const Band& band)
{
  switch (band.sampling) {
    case Sampling::whole:
      return fmt::format("every sample, {:.6g} in a second", band.rate_Hz);
    case Sampling::band_limited:
      return fmt::format("band-limited to {:.4g} Hz, {:.6g} samples in a second", band.to_Hz,
                         band.rate_Hz);
    case Sampling::decimated:
      break;
  }
  return "decimated: frequencies above half its rate look like lower ones";
}

void write_optional(Writer& file, const std::string& name, const std::optional<double>& x,
                    const std::string& unit)
{
  if (x) file.write(name, *x, unit);
}

std::optional<double> read_optional(const Reader& file, const std::string& name)
{
  return file.contains(name) ? std::optional(file.real(name)) : std::nullopt;
}

void write_envelope(Writer& file, const std::string& group, const Envelope& envelope)
{
  file.write(group + "/t", envelope.t, "s");
  file.write(group + "/pad_velocity", envelope.pad_velocity, "m/s");
  file.write(group + "/pad_displacement", envelope.pad_displacement, "m");
}

Envelope read_envelope(const Reader& file, const std::string& group)
{
  const std::vector<double> t = read_times(file, group + "/t");
  const auto n = static_cast<Eigen::Index>(t.size());
  return {t, read_series(file, group + "/pad_velocity", n),
          read_series(file, group + "/pad_displacement", n)};
}

void write_transient(Writer& file, const Transient& run)
{
  file.write("transient/speed", run.speed, "rad/s");
  file.write("transient/step", run.step, "s");
  file.write("transient/finished", std::int64_t{run.finished}, "1");
  file.write("transient/integrator", run.integrator);
  file.write("transient/integrator_reason", run.integrator_reason);
  file.write("transient/steps", run.n_steps, "1");
  if (!run.warning.empty()) file.write("transient/warning", run.warning);
  file.write("transient/contact_evaluations", run.n_contact_evaluations, "1");
  file.write("transient/N_min", run.N_min, "N");
  file.write("transient/N_max", run.N_max, "N");
  file.write("transient/slip_speed_min", run.slip_speed_min, "m/s");
  write_optional(file, "transient/t_zero_force", run.t_zero_force, "s");
  write_optional(file, "transient/growth_rate", run.growth_rate, "1/s");
  write_events(file, run);
  write_envelope(file, "transient/envelope", run.envelope);
  write_windows(file, run.windows);
  write_history(file, "transient/history", run.history);
  write_band(file, run.band);
  write_history(file, "transient/tail", run.tail);
}

Transient read_transient(const Reader& file)
{
  std::vector<ContactEvent> events = read_events(file);
  const std::int64_t n_events = file.contains("transient/events/count")
                                    ? file.integer("transient/events/count")
                                    : std::ssize(events);
  return {.speed = file.real("transient/speed"),
          .step = file.real("transient/step"),
          .finished = file.integer("transient/finished") != 0,
          .integrator = file.text("transient/integrator"),
          .integrator_reason = file.text("transient/integrator_reason"),
          .n_steps = file.integer("transient/steps"),
          .n_contact_evaluations = file.integer("transient/contact_evaluations"),
          .n_events = n_events,
          .events = std::move(events),
          .envelope = read_envelope(file, "transient/envelope"),
          .windows = read_windows(file),
          .band = read_band(file),
          .history = read_history(file, "transient/history"),
          .tail = read_history(file, "transient/tail"),
          .tail_a = {},
          .N_min = file.real("transient/N_min"),
          .N_max = file.real("transient/N_max"),
          .slip_speed_min = file.real("transient/slip_speed_min"),
          .t_zero_force = read_optional(file, "transient/t_zero_force"),
          .growth_rate = read_optional(file, "transient/growth_rate"),
          .warning =
              file.contains("transient/warning") ? file.text("transient/warning") : std::string()};
}

namespace {

const std::string group = "motion_statistics/";

/// A scalar dataset and the member that it holds.
struct Scalar {
  const char* name;
  const char* unit;
  double MotionStatistics::*member;
};

constexpr std::array<Scalar, 12> scalars{{
    {"speed", "rad/s", &MotionStatistics::speed},
    {"from", "s", &MotionStatistics::from},
    {"band", "Hz", &MotionStatistics::band_Hz},
    {"rms_velocity", "m/s", &MotionStatistics::rms_velocity},
    {"peak_velocity", "m/s", &MotionStatistics::peak_velocity},
    {"rms_displacement", "m", &MotionStatistics::rms_displacement},
    {"peak_displacement", "m", &MotionStatistics::peak_displacement},
    {"N_min", "N", &MotionStatistics::N_min},
    {"N_max", "N", &MotionStatistics::N_max},
    {"open", "1", &MotionStatistics::open},
    {"drift", "1", &MotionStatistics::drift},
    {"modulation", "1", &MotionStatistics::modulation},
}};

std::vector<MotionStatistics::Line> read_lines(const files::Reader& file)
{
  const Eigen::VectorXd frequency = file.vector(group + "lines/frequency");
  const Eigen::Index n = frequency.size();
  const Eigen::VectorXd amplitude = file.vector(group + "lines/amplitude", n);
  const Eigen::VectorXd rotations = file.vector(group + "lines/rotations", n);
  std::vector<MotionStatistics::Line> lines;
  for (Eigen::Index i = 0; i < n; ++i) lines.push_back({frequency[i], amplitude[i], rotations[i]});
  return lines;
}

}  // namespace

void write_statistics(files::Writer& file, const MotionStatistics& statistics)
{
  for (const Scalar& scalar : scalars)
    file.write(group + scalar.name, statistics.*scalar.member, scalar.unit);
  file.write(group + "n_rotations", std::int64_t{statistics.n_rotations}, "1");
  file.write(group + "settled", std::int64_t{statistics.settled}, "1");
  file.write(group + "rms_over_angle", statistics.rms_over_angle, "m/s");
  std::vector<double> frequency, amplitude, rotations;
  for (const MotionStatistics::Line& line : statistics.lines) {
    frequency.push_back(line.frequency_Hz);
    amplitude.push_back(line.amplitude);
    rotations.push_back(line.rotations);
  }
  file.write(group + "lines/frequency", frequency, "Hz");
  file.write(group + "lines/amplitude", amplitude, "m/s");
  file.write(group + "lines/rotations", rotations, "1");
}

MotionStatistics read_statistics(const files::Reader& file)
{
  MotionStatistics statistics{};
  for (const Scalar& scalar : scalars) statistics.*scalar.member = file.real(group + scalar.name);
  statistics.n_rotations = mbs_export::file_parts::read_count(file, group + "n_rotations");
  statistics.settled = file.integer(group + "settled") != 0;
  statistics.rms_over_angle = read_some(file, group + "rms_over_angle");
  statistics.lines = read_lines(file);
  return statistics;
}

}  // namespace chladni::squeal
