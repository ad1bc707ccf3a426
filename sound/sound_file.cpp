#include "sound/sound_file.hpp"

#include <fmt/format.h>

#include <numbers>
#include <span>

#include "common/eigen_every.hpp"
#include "common/files/hdf5.hpp"
#include "mbs_export/files/body_files.hpp"
#include "sound/tone.hpp"

namespace chladni::sound {
namespace {

using Eigen::Index;
using files::Writer;

void write_radiation(Writer& file, const squeal::Radiation& radiation)
{
  file.write("radiation/mode_numbers", std::span<const int>(radiation.mode_numbers), "1");
  file.write("radiation/frequencies", radiation.omega, "rad/s");
  file.write("radiation/evaluated_at", radiation.at, "rad/s");
  file.write("radiation/damping", radiation.damping, "1/s");
  file.write("radiation/added_mass", radiation.added_mass, "1");
}

void write_brake(Writer& file, const std::string& group, const Brake& brake)
{
  file.write(group + "/growth", brake.growth, "1/s");
  file.write(group + "/stability", brake.stability);
  if (brake.critical) {
    file.write(group + "/critical_speed", brake.critical->speed, "rad/s");
    file.write(group + "/critical_frequency", brake.critical->frequency_Hz, "Hz");
  }
  if (!brake.cycle) return;
  file.write(group + "/frequency", brake.cycle->frequency_Hz, "Hz");
  file.write(group + "/pad_velocity", brake.cycle->pad_velocity, "m/s");
  file.write(group + "/pad_displacement", brake.cycle->pad_displacement, "m");
}

void write_tone(Writer& file, const Tone& tone, const Accuracy& accuracy)
{
  const std::string group = fmt::format("tones/{}", tone.h);
  file.write(group + "/frequency", tone.omega / (2.0 * std::numbers::pi), "Hz");
  file.write(group + "/power", near_power(tone), "W");
  file.write(group + "/far_power", near_power(tone) * (1.0 + accuracy.balance), "W");
  if (accuracy.pressure) {
    file.write(group + "/pressure_error", *accuracy.pressure, "1");
    file.write(group + "/power_error", *accuracy.power(), "1");
  }
  file.write(group + "/unknowns", std::int64_t{tone.n_unknowns}, "1");
  file.write(group + "/elements", std::int64_t{tone.n_elements}, "1");
  for (const Field& field : tone.fields) {
    if (field.mesh->dimension() == 3) continue;
    const std::string name = fmt::format("{}/meridian/{}", group, field.wave.n);
    const Triangles triangles = inner_triangles(*field.mesh);
    file.write(name + "/nodes", triangles.nodes, "m");
    file.write(name + "/triangles", triangles.corners, "1");
    const Eigen::MatrixXcd p = field.p(triangles.index, every);
    file.write(name + "/cosine_re", p.col(0).real(), "Pa");
    file.write(name + "/cosine_im", p.col(0).imag(), "Pa");
    file.write(name + "/sine_re", p.col(1).real(), "Pa");
    file.write(name + "/sine_im", p.col(1).imag(), "Pa");
  }
}

void write_microphones(Writer& file, const SoundResults& results)
{
  const auto n = static_cast<Index>(results.microphones.size());
  const auto n_tones = static_cast<Index>(results.tones.size());
  std::vector<std::string> names;
  Eigen::MatrixXd positions(n, 3), re(n, n_tones), im(n, n_tones), levels(n, 3), rms(n, 2);
  for (Index i = 0; i < n; ++i) {
    const Heard& heard = results.heard[std::size_t(i)];
    names.push_back(results.microphones[std::size_t(i)].name);
    positions.row(i) = results.microphones[std::size_t(i)].x.transpose();
    re.row(i) = heard.pressure.real().transpose();
    im.row(i) = heard.pressure.imag().transpose();
    levels.row(i) << heard.rms_dB, heard.peak_dB, heard.A_dB;
    rms.row(i) << heard.least, heard.largest;
  }
  file.write("microphones/names", names);
  file.write("microphones/positions", positions, "m");
  file.write("microphones/pressure_re", re, "Pa");
  file.write("microphones/pressure_im", im, "Pa");
  file.write("microphones/levels", levels, "dB");
  file.write("microphones/around_axis", rms, "Pa");
}

void write_loudness(Writer& file, const std::vector<Loudness>& all)
{
  for (const bool damped : {false, true}) {
    std::vector<double> speed, frequency, velocity, power, level;
    for (const Loudness& at : all) {
      if (at.damped != damped || at.frequency_Hz == 0.0) continue;
      speed.push_back(at.speed);
      frequency.push_back(at.frequency_Hz);
      velocity.push_back(at.pad_velocity);
      power.push_back(at.power);
      level.insert(level.end(), at.rms_dB.begin(), at.rms_dB.end());
    }
    const std::string group = damped ? "loudness/with_radiation" : "loudness/without_radiation";
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto n = static_cast<Index>(speed.size());
    file.write(group + "/speeds", speed, "rad/s");
    file.write(group + "/frequency", frequency, "Hz");
    file.write(group + "/pad_velocity", velocity, "m/s");
    file.write(group + "/power", power, "W");
    const Rows levels =
        n == 0 ? Rows(0, 0)
               : Rows(Eigen::Map<const Rows>(level.data(), n, Index(level.size()) / n));
    file.write(group + "/levels", levels, "dB");
  }
}

}  // namespace

void write_sound(const std::filesystem::path& path, const SoundResults& results,
                 const mbs_export::Provenance& provenance)
{
  Writer file(path.string());
  file.attribute("/", "format", "chladni-sound");
  file.attribute("/", "version", std::int64_t{1});
  file.attribute("/", "title", "");
  file.write("medium/density", results.medium.density, "kg/m^3");
  file.write("medium/speed_of_sound", results.medium.speed_of_sound, "m/s");
  file.write("circumferential_harmonics", std::span<const int>(results.harmonics), "1");
  file.write("residual", results.residual, "1");
  write_radiation(file, results.radiation);
  if (results.feedback) {
    file.write("feedback/speed", results.feedback->speed, "rad/s");
    write_brake(file, "feedback/without_radiation", results.feedback->without);
    write_brake(file, "feedback/with_radiation", results.feedback->with);
  }
  if (results.vibration) {
    file.write("speed", results.vibration->speed, "rad/s");
    file.write("frequency", results.vibration->omega / (2.0 * std::numbers::pi), "Hz");
  }
  for (std::size_t i = 0; i < results.tones.size(); ++i)
    write_tone(file, results.tones[i], results.accuracy[i]);
  if (!results.notes.empty()) file.write("notes", results.notes);
  if (!results.heard.empty()) write_microphones(file, results);
  if (results.directivity) {
    file.write("directivity/polar", results.directivity->polar, "rad");
    file.write("directivity/azimuth", results.directivity->azimuth, "rad");
    file.write("directivity/rms", results.directivity->rms, "Pa m");
  }
  if (!results.loudness.empty()) write_loudness(file, results.loudness);
  mbs_export::file_parts::write_provenance(file, provenance);
  file.commit();
}

}  // namespace chladni::sound
