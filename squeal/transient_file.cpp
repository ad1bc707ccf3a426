#include "squeal/transient_file.hpp"

#include <limits>
#include <utility>
#include <vector>

#include "mbs_export/files/file_parts.hpp"
#include "squeal/file_checks.hpp"

namespace chladni::squeal {
namespace {

using files::Reader;
using files::Writer;

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

/// One row for each time, as everything else of a history.
void write_modes(Writer& file, const std::string& group, const ModalHistory& modes)
{
  file.write(group + "/q", modes.q.transpose(), "m kg^(1/2)");
  file.write(group + "/q_dot", modes.v.transpose(), "m kg^(1/2) / s");
  file.write(group + "/energy", modes.energy, "J");
}

/// At n times, or none: models without a body have no modes.
ModalHistory read_modes(const Reader& file, const std::string& group, Eigen::Index n)
{
  const std::vector<double> energy = read_series(file, group + "/energy");
  const auto n_energies = static_cast<Eigen::Index>(energy.size());
  if (n_energies != n && n_energies != 0)
    file.fail(group + "/energy", "expected as many values as there are times, or none");
  const Eigen::MatrixXd q = file.matrix(group + "/q", {n_energies});
  return {q.transpose(), file.matrix(group + "/q_dot", {n_energies, q.cols()}).transpose(), energy};
}

void write_events(Writer& file, const std::vector<ContactEvent>& events)
{
  std::vector<double> t;
  std::vector<int> pads, gains;
  for (const ContactEvent& event : events) {
    t.push_back(event.t);
    pads.push_back(event.pad);
    gains.push_back(event.gains ? 1 : 0);
  }
  file.write("transient/events/t", t, "s");
  file.write("transient/events/pad", std::span<const int>(pads), "1");
  file.write("transient/events/gains", std::span<const int>(gains), "1");
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
  write_events(file, run.events);
  write_envelope(file, "transient/envelope", run.envelope);
  write_history(file, "transient/history", run.history);
  write_modes(file, "transient/history", run.modes);
  write_history(file, "transient/tail", run.tail);
}

Transient read_transient(const Reader& file)
{
  History history = read_history(file, "transient/history");
  const auto n = static_cast<Eigen::Index>(history.t.size());
  return {.speed = file.real("transient/speed"),
          .step = file.real("transient/step"),
          .finished = file.integer("transient/finished") != 0,
          .integrator = file.text("transient/integrator"),
          .integrator_reason = file.text("transient/integrator_reason"),
          .n_steps = file.integer("transient/steps"),
          .n_contact_evaluations = file.integer("transient/contact_evaluations"),
          .events = read_events(file),
          .envelope = read_envelope(file, "transient/envelope"),
          .history = std::move(history),
          .modes = read_modes(file, "transient/history", n),
          .tail = read_history(file, "transient/tail"),
          .sound = {},
          .tail_a = {},
          .N_min = file.real("transient/N_min"),
          .N_max = file.real("transient/N_max"),
          .slip_speed_min = file.real("transient/slip_speed_min"),
          .t_zero_force = read_optional(file, "transient/t_zero_force"),
          .growth_rate = read_optional(file, "transient/growth_rate"),
          .warning =
              file.contains("transient/warning") ? file.text("transient/warning") : std::string()};
}

}  // namespace chladni::squeal
