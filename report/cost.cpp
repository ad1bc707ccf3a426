#include "report/cost.hpp"

#include <fmt/format.h>

#include <utility>

namespace chladni::report {

Cost cost_so_far(std::vector<PhaseTime> phases)
{
  return {.phases = std::move(phases),
          .wall_s = process_wall_s(),
          .cpu_s = process_cpu_s(),
          .peak_MiB = peak_MiB()};
}

TextTable cost_table(const Cost& cost)
{
  TextTable table{.header = {"phase", "wall, s", "CPU, s"}, .rows = {}};
  for (const PhaseTime& phase : cost.phases) {
    table.rows.push_back(
        {phase.name, fmt::format("{:.3f}", phase.wall_s), fmt::format("{:.3f}", phase.cpu_s)});
  }
  table.rows.push_back(
      {"whole program", fmt::format("{:.3f}", cost.wall_s), fmt::format("{:.3f}", cost.cpu_s)});
  table.rows.push_back({fmt::format("peak memory {:.0f} MiB", cost.peak_MiB), "", ""});
  return table;
}

std::vector<Json::Member> cost_json(const Cost& cost)
{
  std::vector<Json::Member> wall;
  std::vector<Json::Member> cpu;
  for (const PhaseTime& phase : cost.phases) {
    wall.emplace_back(phase.name, phase.wall_s);
    cpu.emplace_back(phase.name, phase.cpu_s);
  }
  return {{"phases", Json::object(wall)},
          {"phases_cpu_s", Json::object(cpu)},
          {"wall_s", cost.wall_s},
          {"cpu_s", cost.cpu_s},
          {"peak_MiB", cost.peak_MiB}};
}

}  // namespace chladni::report
