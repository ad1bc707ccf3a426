#include "report/page/runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "common/error.hpp"

namespace chladni::report {

std::vector<ReportSource> runs_of(const ReportArguments& arguments)
{
  const std::size_t n_scenes = arguments.scenes.size(), n_folders = arguments.outputs.size();
  if (n_scenes > 1 && n_folders > 1 && n_scenes != n_folders) {
    throw Error(
        fmt::format("report: {} scenes and {} folders; name one folder for all scenes, or "
                    "one for each (--output once for each)",
                    n_scenes, n_folders));
  }
  std::vector<ReportSource> sources;
  for (std::size_t i = 0; i < std::max(n_scenes, n_folders); ++i) {
    sources.push_back({.scene = scene::read_scene(arguments.scenes[n_scenes > 1 ? i : 0]),
                       .folder = arguments.outputs[n_folders > 1 ? i : 0],
                       .stale = arguments.stale ? Stale::use : Stale::refuse});
  }
  return sources;
}

std::vector<std::string> labels_of(const std::vector<ReportSource>& sources)
{
  using Label = std::function<std::string(const ReportSource&)>;
  const std::vector<Label> choices{
      [](const ReportSource& source) { return source.scene.title; },
      [](const ReportSource& source) { return source.folder.string(); },
      [](const ReportSource& source) { return source.scene.path; },
      [](const ReportSource& source) {
        return fmt::format("{} in {}", source.scene.path, source.folder.string());
      }};
  std::vector<std::string> labels(sources.size());
  for (const Label& label : choices) {
    std::ranges::transform(sources, labels.begin(), label);
    const std::set<std::string> different(labels.begin(), labels.end());
    if (different.size() == sources.size() && !different.contains("")) break;
  }
  return labels;
}

}  // namespace chladni::report
