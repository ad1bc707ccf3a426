#include "report/page/motion_statistics.hpp"

#include "report/page/numbers.hpp"

namespace chladni::report {

Json statistics_page(const squeal::MotionStatistics& statistics)
{
  std::vector<Json> lines;
  for (const squeal::MotionStatistics::Line& line : statistics.lines) {
    lines.push_back(Json::object({{"frequency_Hz", rounded(line.frequency_Hz)},
                                  {"amplitude", rounded(line.amplitude)},
                                  {"rotations", rounded(line.rotations)}}));
  }
  return Json::object({{"speed", rounded(statistics.speed)},
                       {"n_rotations", double(statistics.n_rotations)},
                       {"rms_velocity", rounded(statistics.rms_velocity)},
                       {"peak_velocity", rounded(statistics.peak_velocity)},
                       {"peak_displacement", rounded(statistics.peak_displacement)},
                       {"N_min", rounded(statistics.N_min)},
                       {"N_max", rounded(statistics.N_max)},
                       {"modulation", rounded(statistics.modulation)},
                       {"doubt", statistics.settled ? "" : "not settled"},
                       {"rms_over_angle", rounded(statistics.rms_over_angle)},
                       {"lines", Json::array(lines)}});
}

}  // namespace chladni::report
