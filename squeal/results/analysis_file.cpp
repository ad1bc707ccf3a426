#include "squeal/results/analysis_file.hpp"

#include <fmt/format.h>

#include <complex>
#include <span>

#include "mbs_export/files/file_parts.hpp"
#include "squeal/results/file_checks.hpp"
#include "squeal/results/stability_file.hpp"

namespace chladni::squeal {
namespace {

using files::Reader;
using files::Writer;

Eigen::MatrixXcd complex_matrix(const Eigen::MatrixXd& re, const Eigen::MatrixXd& im)
{
  return re + std::complex<double>(0.0, 1.0) * im;
}

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
