#include "squeal/results/statistics_file.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mbs_export/files/file_parts.hpp"
#include "squeal/results/file_checks.hpp"

namespace chladni::squeal {
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
