#include "squeal/study/study_steps.hpp"

#include <algorithm>
#include <utility>

#include "common/error.hpp"

namespace chladni::squeal {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name)
{
  return std::ranges::find(names, name) != names.end();
}

/// The limit cycle is measured on what a file does not hold of its transient.
bool is_to_do(const StudyStep& step, const std::vector<std::string>& missing)
{
  return contains(missing, step.names.front()) ||
         (step.names.front() == "transient" && contains(missing, "limit-cycle"));
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

}  // namespace

SquealResults perform_steps(const std::vector<StudyStep>& steps,
                            const std::vector<std::string>& analyses, SquealResults results,
                            const StudyKeeping& keeping)
{
  std::vector<StudyStep> to_do;
  for (const StudyStep& step : steps)
    if (std::ranges::find_first_of(analyses, step.names) != analyses.end()) to_do.push_back(step);
  const bool goes_on = !keeping.begin.missing.empty();
  if (goes_on) {
    std::erase_if(to_do, [&](const auto& step) { return !is_to_do(step, keeping.begin.missing); });
    results = keeping.begin;
    results.failure.reset();
  }
  results.missing.clear();
  for (const StudyStep& step : to_do) results.missing.push_back(step.names.front());
  bool any_done = goes_on;
  if (keeping.unfinished && !to_do.empty()) keeping.unfinished(results);
  double n_done = 0.0;
  for (const StudyStep& step : to_do) {
    if (any_done) keep_unfinished(keeping, results);
    const std::string& name = step.names.front();
    const auto report = [&](double fraction) {
      if (keeping.progress) keeping.progress(name, (n_done + fraction) / double(to_do.size()));
    };
    report(0.0);
    try {
      step.perform(results, {report, keeping.checkpoint, keeping.sound});
    } catch (const Error& error) {
      results.failure = error.what();
      keep_unfinished(keeping, results);
      if (!any_done) throw;
      return results;
    }
    std::erase(results.missing, name);
    any_done = true;
    n_done += 1.0;
  }
  if (results.transient && !results.transient->finished)
    results.failure = "transient: " + divergence_of(*results.transient);
  return results;
}

}  // namespace chladni::squeal
