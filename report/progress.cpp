#include "report/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace chladni::report {

namespace {

bool is_quiet = false;

}  // namespace

WholeProgress::WholeProgress(std::vector<Stage> stages) : stages_(std::move(stages)) {}

void WholeProgress::enter(const std::string& phase)
{
  phase_ = phase;
  const auto found = std::ranges::find(stages_, phase, &Stage::name);
  if (found == stages_.end()) return;
  const auto i = static_cast<std::size_t>(found - stages_.begin());
  left_ = stage_ == i ? 0.5 * left_ : 1.0;
  stage_ = i;
}

double WholeProgress::at(const std::string& phase, double fraction)
{
  if (phase != phase_) enter(phase);
  if (!stage_ || stages_[*stage_].name != phase) return done_;
  double total = 0.0, over = 0.0;
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    total += stages_[i].share;
    if (i < *stage_) over += stages_[i].share;
  }
  const double of_this_time = (stages_[*stage_].times == Times::once ? 1.0 : 0.5) * left_;
  over += stages_[*stage_].share * (1.0 - left_ + of_this_time * std::min(fraction, 1.0));
  done_ = std::max(done_, total > 0.0 ? over / total : 0.0);
  return done_;
}

namespace {

/// ", 7 s left", or nothing where that cannot be known yet.
std::string time_left(double done, double elapsed_s)
{
  constexpr double shortest_worth_telling_s = 2.0, least_to_go_by = 0.02;
  if (elapsed_s < shortest_worth_telling_s || done < least_to_go_by) return "";
  return fmt::format(", {:.0f} s left", std::ceil(elapsed_s * (1.0 - done) / done));
}

}  // namespace

std::string progress_text(std::string_view phase, double whole, double elapsed_s)
{
  constexpr int width = 20;
  const double done = std::clamp(whole, 0.0, 1.0);
  const int n = static_cast<int>(width * done);
  return fmt::format("[{}{}] {:3.0f} %  {}{}", std::string(n, '#'), std::string(width - n, '-'),
                     std::floor(100.0 * done), phase, time_left(done, elapsed_s));
}

std::optional<std::string> ProgressLog::line(std::string_view phase, double whole, double elapsed_s)
{
  constexpr double rarest_s = 60.0;
  if (elapsed_s < next_s_) return std::nullopt;
  next_s_ = elapsed_s + std::min(elapsed_s, rarest_s);
  const double done = std::clamp(whole, 0.0, 1.0);
  return fmt::format("{:.0f} s: {:.0f} %  {}{}", elapsed_s, std::floor(100.0 * done), phase,
                     time_left(done, elapsed_s));
}

void be_quiet()
{
  is_quiet = true;
  // Not the file behind it, which --json may name.
  if (std::FILE* nowhere = std::fopen("/dev/null", "w")) stdout = nowhere;
}

void tell_note(std::string_view note)
{
  fmt::print(stderr, "{}note: {}\n", ::isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "", note);
}

ProgressLine::~ProgressLine()
{
  wipe();
}

void ProgressLine::wipe()
{
  if (visible_) fmt::print(stderr, "\r\033[K");
  visible_ = false;
}

void ProgressLine::draw(const std::string& phase, double whole, Clock::time_point now)
{
  constexpr std::chrono::milliseconds pause{200};
  // The name of a phase at once: a factorisation says nothing until it is done.
  if (phase == phase_ && now - shown_ < pause && whole < 1.0) return;
  phase_ = phase;
  shown_ = now;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  fmt::print(stderr, "\r\033[K{}", progress_text(phase, whole, elapsed_s));
  std::fflush(stderr);
  visible_ = true;
}

void ProgressLine::show(const std::string& phase, double whole)
{
  if (is_quiet) return;
  const Clock::time_point now = Clock::now();
  if (::isatty(STDERR_FILENO) != 0) return draw(phase, whole, now);
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  if (const auto line = log_.line(phase, whole, elapsed_s)) fmt::print(stderr, "{}\n", *line);
}

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
