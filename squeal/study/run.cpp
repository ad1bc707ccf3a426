#include "squeal/study/run.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/study/analysis_steps.hpp"
#include "squeal/study/validate.hpp"

namespace chladni::squeal {
namespace {

bool contains(const std::vector<std::string>& names, std::string_view name)
{
  return std::ranges::find(names, name) != names.end();
}

/// Whether the analyses ask for a step, or for one that begins with its result.
bool is_asked_for(const AnalysisStep& step, const std::vector<std::string>& analyses)
{
  return contains(analyses, step.name) ||
         std::ranges::any_of(step.serves, [&](auto name) { return contains(analyses, name); });
}

/// Whether a run that goes on has to do a step. The limit cycle is measured on what a file does not
/// hold of its transient.
bool is_to_do(const AnalysisStep& step, const std::vector<std::string>& missing)
{
  return contains(missing, step.name) ||
         (step.name == "transient" && contains(missing, "limit-cycle"));
}

/// What there is so far. A disk that is full meanwhile ends no study; what is written at its end
/// tells of it.
void keep_unfinished(const StudyKeeping& keeping, const SquealResults& results)
{
  if (!keeping.unfinished) return;
  try {
    keeping.unfinished(results);
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch)
  }
}

/// The steps, and the results with which they begin.
struct Beginning {
  std::vector<AnalysisStep> to_do;
  SquealResults results;
  bool goes_on;  ///< where another run has ended
};

Beginning beginning_of(const Study& study, const StudyKeeping& keeping)
{
  Beginning begin{.to_do = {}, .results = {}, .goes_on = !keeping.begin.missing.empty()};
  SquealResults& results = begin.results;
  results.wheel_radius = study.options.speeds.wheel_radius;
  if (const FlexibleDisc* body = study.brake.body(); body && body->find_inertial())
    results.largest_split = body->inertial().largest_split;
  if (begin.goes_on) results = keeping.begin;
  results.failure.reset();
  results.missing.clear();
  for (const AnalysisStep& step : analysis_steps()) {
    if (!is_asked_for(step, study.options.analyses)) continue;
    if (begin.goes_on && !is_to_do(step, keeping.begin.missing)) continue;
    begin.to_do.push_back(step);
    results.missing.emplace_back(step.name);
  }
  return begin;
}

}  // namespace

SquealResults run(const Brake& brake, const StudyOptions& options, const StudyKeeping& keeping)
{
  validate(brake, options);
  TurningTables turning;
  const Study study{brake, options, turning};
  Beginning begin = beginning_of(study, keeping);
  const std::vector<AnalysisStep>& to_do = begin.to_do;
  SquealResults& results = begin.results;
  bool any_done = begin.goes_on;
  if (keeping.unfinished && !to_do.empty()) keeping.unfinished(results);
  double done = 0.0, all = 0.0;
  for (const AnalysisStep& step : to_do) all += step.share;
  for (const AnalysisStep& step : to_do) {
    if (any_done) keep_unfinished(keeping, results);
    const std::string name(step.name);
    const auto report = [&](double fraction) {
      if (keeping.progress) keeping.progress(name, (done + fraction * step.share) / all);
    };
    report(0.0);
    try {
      step.perform(study, results, {report, keeping.checkpoint, keeping.sound});
    } catch (const Error& error) {
      results.failure = error.what();
      keep_unfinished(keeping, results);
      if (!any_done) throw;
      return std::move(begin.results);
    }
    std::erase(results.missing, name);
    any_done = true;
    report(1.0);
    done += step.share;
  }
  if (results.transient && !results.transient->finished)
    results.failure = "transient: " + divergence_of(*results.transient);
  return std::move(begin.results);
}

}  // namespace chladni::squeal
