#include "squeal/results/result_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "files/hdf5.hpp"
#include "mbs_export/files/file_parts.hpp"
#include "mbs_export/files/provenance.hpp"
#include "squeal/results/analysis_file.hpp"
#include "squeal/results/cycle_file.hpp"
#include "squeal/results/file_checks.hpp"
#include "squeal/results/gradient_file.hpp"
#include "squeal/results/rotation_file.hpp"
#include "squeal/results/sensitivity_file.hpp"
#include "squeal/results/stability_file.hpp"
#include "squeal/results/stability_table_file.hpp"
#include "squeal/results/statistics_file.hpp"
#include "squeal/results/transient_file.hpp"

namespace chladni::squeal {
namespace {

using files::Reader;
using files::Writer;

constexpr std::int64_t file_version = 1;

Eigen::MatrixXcd complex_matrix(const Eigen::MatrixXd& re, const Eigen::MatrixXd& im)
{
  return re + std::complex<double>(0.0, 1.0) * im;
}

void write_critical_speed(Writer& file, const SquealResults& results)
{
  const auto& critical = results.critical_speed;
  file.group("critical");
  if (results.speed_stability) write_profile(file, "critical", *results.speed_stability, "rad/s");
  if (!critical) return;
  file.write("critical/speed", critical->speed, "rad/s");
  file.write("critical/frequency", critical->frequency_Hz, "Hz");
  file.write("critical/newton_steps", std::int64_t{critical->n_newton_steps}, "1");
  for (const auto& [name, part] : budget_parts)
    if (critical->budget.*part)
      file.write(fmt::format("critical/errors/{}", name), *(critical->budget.*part), "rad/s");
}

CriticalSpeed read_critical_speed(const Reader& file)
{
  CriticalSpeed critical{file.real("critical/speed"), file.real("critical/frequency")};
  if (file.contains("critical/newton_steps"))
    critical.n_newton_steps = mbs_export::file_parts::read_count(file, "critical/newton_steps");
  for (const auto& [name, part] : budget_parts) {
    const std::string path = fmt::format("critical/errors/{}", name);
    if (file.contains(path)) critical.budget.*part = file.real(path);
  }
  return critical;
}

void write_map(Writer& file, const StabilityMap& map)
{
  file.write("stability_map/parameter", map.parameter);
  file.write("stability_map/values", map.values, unit_of(map.parameter));
  file.write("stability_map/speeds", map.speeds, "rad/s");
  file.write("stability_map/growth", map.growth, "1/s");
  file.write("stability_map/frequency", map.frequency_Hz, "Hz");
}

StabilityMap read_map(const Reader& file)
{
  const Eigen::VectorXd values = read_some(file, "stability_map/values");
  const Eigen::VectorXd speeds = read_some(file, "stability_map/speeds");
  return {.parameter = file.text("stability_map/parameter"),
          .values = values,
          .speeds = speeds,
          .growth = file.matrix("stability_map/growth", {values.size(), speeds.size()}),
          .frequency_Hz = file.matrix("stability_map/frequency", {values.size(), speeds.size()})};
}

void write_growth(Writer& file, const std::string& group, const Growth& growth)
{
  file.write(group + "/speed", growth.speed, "rad/s");
  file.write(group + "/rate", growth.rate, "1/s");
  write_optional(file, group + "/eigenvalue_rate", growth.eigenvalue_rate, "1/s");
  write_envelope(file, group + "/envelope", growth.envelope);
}

Growth read_growth(const Reader& file, const std::string& group)
{
  return {file.real(group + "/speed"), read_envelope(file, group + "/envelope"),
          file.real(group + "/rate"), read_optional(file, group + "/eigenvalue_rate")};
}

void write_limit_cycle(Writer& file, const LimitCycle& cycle)
{
  file.write("limit_cycle/speed", cycle.speed, "rad/s");
  file.write("limit_cycle/frequency", cycle.frequency_Hz, "Hz");
  file.write("limit_cycle/pad_velocity", cycle.pad_velocity, "m/s");
  file.write("limit_cycle/pad_displacement", cycle.pad_displacement, "m");
  file.write("limit_cycle/N_min", cycle.N_min, "N");
  file.write("limit_cycle/N_max", cycle.N_max, "N");
  file.write("limit_cycle/drift", cycle.drift, "1");
  file.write("limit_cycle/settled", std::int64_t{cycle.settled}, "1");
  write_optional(file, "limit_cycle/t_zero_force", cycle.t_zero_force, "s");
  file.write("limit_cycle/t_99", cycle.t_99, "s");
  file.write("limit_cycle/mode_numbers", std::span<const int>(cycle.mode_numbers), "1");
  file.write("limit_cycle/amplitude_re", cycle.amplitude.real(), "m kg^(1/2)");
  file.write("limit_cycle/amplitude_im", cycle.amplitude.imag(), "m kg^(1/2)");
}

LimitCycle read_limit_cycle(const Reader& file)
{
  std::vector<int> numbers = read_mode_numbers(file, "limit_cycle/mode_numbers");
  const Eigen::VectorXd re = file.vector("limit_cycle/amplitude_re");
  const Eigen::VectorXd im = file.vector("limit_cycle/amplitude_im", re.size());
  if (re.size() != 0 && re.size() != static_cast<Eigen::Index>(numbers.size()))
    file.fail("limit_cycle/amplitude_re", "it must have one value for each mode");
  return {.speed = file.real("limit_cycle/speed"),
          .frequency_Hz = file.real("limit_cycle/frequency"),
          .pad_velocity = file.real("limit_cycle/pad_velocity"),
          .pad_displacement = file.real("limit_cycle/pad_displacement"),
          .N_min = file.real("limit_cycle/N_min"),
          .N_max = file.real("limit_cycle/N_max"),
          .drift = file.real("limit_cycle/drift"),
          .settled = file.integer("limit_cycle/settled") != 0,
          .t_zero_force = read_optional(file, "limit_cycle/t_zero_force"),
          .t_99 = file.real("limit_cycle/t_99"),
          .mode_numbers = std::move(numbers),
          .amplitude = complex_matrix(re, im)};
}

}  // namespace

void write_results(const std::filesystem::path& path, const SquealResults& results,
                   const mbs_export::Provenance& provenance)
{
  Writer file(path.string());
  file.attribute("/", "format", results_format);
  file.attribute("/", "version", file_version);
  mbs_export::file_parts::write_provenance(file, provenance);
  write_optional(file, "largest_split", results.largest_split, "1");
  write_optional(file, "wheel_radius", results.wheel_radius, "m");
  if (results.eigenvalues) write_eigenvalues(file, *results.eigenvalues);
  if (results.searched_critical_speed) write_critical_speed(file, results);
  write_critical_values(file, results.critical_values);
  if (results.stability_table) write_stability_table(file, *results.stability_table);
  if (results.map) write_map(file, *results.map);
  if (results.rotation_stability) write_rotation_stability(file, *results.rotation_stability);
  if (results.mode_sensitivity) write_sensitivity(file, *results.mode_sensitivity);
  if (results.gradients) write_gradients(file, *results.gradients);
  for (std::size_t i = 0; i < results.growth.size(); ++i)
    write_growth(file, fmt::format("growth/{}", i + 1), results.growth[i]);
  if (results.transient) write_transient(file, *results.transient);
  if (results.limit_cycle) write_limit_cycle(file, *results.limit_cycle);
  if (results.limit_cycle_direct) write_direct(file, *results.limit_cycle_direct);
  if (results.limit_cycle_branch) write_branch(file, *results.limit_cycle_branch);
  if (results.spectrum) write_spectrum(file, *results.spectrum);
  if (results.spectrogram) write_spectrogram(file, *results.spectrogram);
  if (results.motion_statistics) write_statistics(file, *results.motion_statistics);
  if (results.failure) file.write("failure", *results.failure);
  if (!results.missing.empty()) file.write("missing", results.missing);
  if (!results.inputs.empty()) file.write("inputs", results.inputs);
  file.commit();
}

SquealResults read_results(const std::filesystem::path& path)
{
  return read_results(Reader(path.string()));
}

SquealResults read_results(const Reader& file)
{
  file.expect_format(results_format, file_version);
  SquealResults results;
  results.largest_split = read_optional(file, "largest_split");
  results.wheel_radius = read_optional(file, "wheel_radius");
  if (file.contains("eigenvalues")) results.eigenvalues = read_eigenvalues(file);
  results.searched_critical_speed = file.contains("critical");
  results.speed_stability = read_profile(file, "critical");
  if (file.contains("critical/speed")) results.critical_speed = read_critical_speed(file);
  results.critical_values = read_critical_values(file);
  if (file.contains("spectrum")) results.spectrum = read_spectrum(file);
  if (file.contains("spectrogram")) results.spectrogram = read_spectrogram(file);
  if (file.contains("motion_statistics")) results.motion_statistics = read_statistics(file);
  if (file.contains("failure")) results.failure = file.text("failure");
  if (file.contains("missing")) results.missing = file.texts("missing");
  if (file.contains("inputs")) results.inputs = file.text("inputs");
  if (file.contains("stability")) results.stability_table = read_stability_table(file);
  if (file.contains("stability_map")) results.map = read_map(file);
  if (file.contains("rotation_stability"))
    results.rotation_stability = read_rotation_stability(file);
  if (file.contains("mode_sensitivity")) results.mode_sensitivity = read_sensitivity(file);
  if (file.contains("gradients")) results.gradients = read_gradients(file);
  for (int i = 1; file.contains(fmt::format("growth/{}", i)); ++i)
    results.growth.push_back(read_growth(file, fmt::format("growth/{}", i)));
  if (file.contains("transient")) results.transient = read_transient(file);
  if (file.contains("limit_cycle")) results.limit_cycle = read_limit_cycle(file);
  if (file.contains("limit_cycle_direct")) results.limit_cycle_direct = read_direct(file);
  if (file.contains("limit_cycle_branch")) results.limit_cycle_branch = read_branch(file);
  return results;
}

}  // namespace chladni::squeal
