#include "squeal/results/squeal_results.hpp"

#include <fmt/format.h>

#include <complex>
#include <span>
#include <utility>

#include "common/files/hdf5.hpp"
#include "mbs_export/files/body_files.hpp"
#include "squeal/results/file_checks.hpp"
#include "squeal/results/limit_cycle_results.hpp"
#include "squeal/results/sensitivity_results.hpp"
#include "squeal/results/stability_results.hpp"
#include "squeal/results/transient_results.hpp"

namespace chladni::squeal {

using files::Reader, files::Writer;

namespace {

constexpr std::int64_t results_version = 1;

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
  file.attribute("/", "version", results_version);
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
  file.expect_format(results_format, results_version);
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

namespace {

std::string shape_group(std::size_t i)
{
  return fmt::format("eigenvalues/shapes/{}", i + 1);
}

}  // namespace

std::string unit_of(const std::string& parameter)
{
  if (parameter == "speed") return "rad/s";
  const auto known = parameter_of(parameter);
  return known ? std::string(find_parameter(known->name)->unit) : "1";
}

void write_eigenvalues(Writer& file, const EigenvalueMap& map)
{
  file.write("eigenvalues/speeds", map.speeds, "rad/s");
  file.write("eigenvalues/lambda_re", map.lambda.real(), "1/s");
  file.write("eigenvalues/lambda_im", map.lambda.imag(), "rad/s");
  if (!map.mode_numbers.empty())
    file.write("eigenvalues/mode_numbers", std::span<const int>(map.mode_numbers), "1");
  for (std::size_t i = 0; i < map.shapes.size(); ++i) {
    file.write(shape_group(i) + "/re", map.shapes[i].real(), "1");
    file.write(shape_group(i) + "/im", map.shapes[i].imag(), "1");
  }
}

EigenvalueMap read_eigenvalues(const Reader& file)
{
  const Eigen::VectorXd speeds = file.vector("eigenvalues/speeds");
  const Eigen::MatrixXd re = file.matrix("eigenvalues/lambda_re", {speeds.size()});
  const Eigen::MatrixXd im = file.matrix("eigenvalues/lambda_im", {speeds.size(), re.cols()});
  if (re.size() == 0) file.fail("eigenvalues/lambda_re", "it must have a value at each speed");
  EigenvalueMap map{speeds, complex_matrix(re, im)};
  if (file.contains("eigenvalues/mode_numbers"))
    map.mode_numbers = read_mode_numbers(file, "eigenvalues/mode_numbers");
  for (std::size_t i = 0; file.contains(shape_group(i)); ++i) {
    const Eigen::MatrixXd shape = file.matrix(shape_group(i) + "/re", {files::any, re.cols()});
    if (shape.rows() < std::ssize(map.mode_numbers))
      file.fail(shape_group(i) + "/re", "expected a row for each of eigenvalues/mode_numbers");
    map.shapes.push_back(
        complex_matrix(shape, file.matrix(shape_group(i) + "/im", {shape.rows(), shape.cols()})));
  }
  if (!map.shapes.empty() && std::ssize(map.shapes) != speeds.size())
    file.fail("eigenvalues/shapes", "there must be those of each speed");
  return map;
}

void write_critical_values(Writer& file, const std::vector<CriticalValue>& values)
{
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string group = fmt::format("critical_values/{}", i + 1);
    const CriticalValue& value = values[i];
    file.write(group + "/parameter", value.parameter);
    file.write(group + "/speed", value.speed, "rad/s");
    if (value.profile) write_profile(file, group, *value.profile, unit_of(value.parameter));
    if (!value.value) continue;
    file.write(group + "/value", *value.value, unit_of(value.parameter));
    file.write(group + "/frequency", value.frequency_Hz, "Hz");
    file.write(group + "/newton_steps", std::int64_t{value.n_newton_steps}, "1");
  }
}

std::vector<CriticalValue> read_critical_values(const Reader& file)
{
  std::vector<CriticalValue> values;
  for (int i = 1; file.contains(fmt::format("critical_values/{}", i)); ++i) {
    const std::string group = fmt::format("critical_values/{}", i);
    CriticalValue value{.parameter = file.text(group + "/parameter"),
                        .speed = file.real(group + "/speed"),
                        .value = {},
                        .frequency_Hz = 0.0,
                        .n_newton_steps = 0,
                        .profile = read_profile(file, group)};
    if (file.contains(group + "/value")) {
      value.value = file.real(group + "/value");
      value.frequency_Hz = file.real(group + "/frequency");
      value.n_newton_steps = mbs_export::file_parts::read_count(file, group + "/newton_steps");
    }
    values.push_back(value);
  }
  return values;
}

void write_spectrum(Writer& file, const Spectrum& spectrum)
{
  file.write("spectrum/frequency", spectrum.frequency_Hz, "Hz");
  file.write("spectrum/amplitude", spectrum.amplitude, "m/s");
  std::vector<double> frequencies, amplitudes;
  for (const Spectrum::Peak& peak : spectrum.peaks) {
    frequencies.push_back(peak.frequency_Hz);
    amplitudes.push_back(peak.amplitude);
  }
  file.write("spectrum/peaks/frequency", frequencies, "Hz");
  file.write("spectrum/peaks/amplitude", amplitudes, "m/s");
}

void write_spectrogram(Writer& file, const Spectrogram& spectrogram)
{
  file.write("spectrogram/t", spectrogram.t, "s");
  file.write("spectrogram/speed", spectrogram.speed, "rad/s");
  file.write("spectrogram/envelope", spectrogram.envelope, "m/s");
  file.write("spectrogram/frequency", spectrogram.frequency_Hz, "Hz");
  file.write("spectrogram/amplitude", spectrogram.amplitude, "m/s");
  file.write("spectrogram/lines/frequency", spectrogram.line_Hz, "Hz");
  file.write("spectrogram/lines/amplitude", spectrogram.line_amplitude, "m/s");
}

Spectrogram read_spectrogram(const Reader& file)
{
  const Eigen::VectorXd t = read_some(file, "spectrogram/t");
  const Eigen::VectorXd f_Hz = read_some(file, "spectrogram/frequency");
  const Eigen::Index n = t.size();
  const Eigen::MatrixXd line_Hz = file.matrix("spectrogram/lines/frequency", {.rows = n});
  return {.t = t,
          .speed = file.vector("spectrogram/speed", n),
          .envelope = file.vector("spectrogram/envelope", n),
          .frequency_Hz = f_Hz,
          .amplitude = file.matrix("spectrogram/amplitude", {n, f_Hz.size()}),
          .line_Hz = line_Hz,
          .line_amplitude = file.matrix("spectrogram/lines/amplitude", {n, line_Hz.cols()})};
}

Spectrum read_spectrum(const Reader& file)
{
  const Eigen::VectorXd frequency = read_some(file, "spectrum/frequency");
  Spectrum spectrum{frequency, file.vector("spectrum/amplitude", frequency.size()), {}};
  const Eigen::VectorXd at = file.vector("spectrum/peaks/frequency");
  const Eigen::VectorXd amplitude = file.vector("spectrum/peaks/amplitude", at.size());
  for (Eigen::Index i = 0; i < at.size(); ++i) spectrum.peaks.push_back({at[i], amplitude[i]});
  return spectrum;
}

void write_energy(Writer& file, const CycleEnergy& energy)
{
  file.write("limit_cycle_direct/energy/friction", energy.friction, "J");
  file.write("limit_cycle_direct/energy/normal", energy.normal, "J");
  file.write("limit_cycle_direct/energy/damping", energy.damping, "J");
  file.write("limit_cycle_direct/energy/heat", energy.heat, "J");
  file.write("limit_cycle_direct/energy/stored", energy.stored, "J");
}

CycleEnergy read_energy(const Reader& file)
{
  const Eigen::VectorXd friction = file.vector("limit_cycle_direct/energy/friction");
  return {friction, file.vector("limit_cycle_direct/energy/normal", friction.size()),
          file.real("limit_cycle_direct/energy/damping"),
          file.vector("limit_cycle_direct/energy/heat", friction.size()),
          file.real("limit_cycle_direct/energy/stored")};
}

}  // namespace chladni::squeal
