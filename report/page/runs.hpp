#pragma once

#include <string>
#include <vector>

#include "report/page/report.hpp"

namespace chladni::report {

/// The runs that the arguments name: scene i with its files in folder i. One scene goes with all
/// folders, and one folder with all scenes.
/// @throws chladni::Error when there are some of both and not as many, or a scene cannot be read.
std::vector<ReportSource> runs_of(const ReportArguments& arguments);

/// What tells the runs from each other: their titles, folders or scene files, the first of which
/// that all differ; else all of it.
std::vector<std::string> labels_of(const std::vector<ReportSource>& sources);

}  // namespace chladni::report
