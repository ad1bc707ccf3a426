#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mbs_export/responses/frequency_responses.hpp"
#include "report/origin.hpp"
#include "scene/scene.hpp"

namespace CLI {

class App;

}  // namespace CLI

namespace chladni::report {

/// Arguments of `chladni report` and `squeal report`.
struct ReportArguments {
  std::vector<std::string> scenes;        ///< of one run, or of some to be compared
  std::vector<std::string> outputs{"."};  ///< folders of their files; the page is in the first
  std::string benchmark = {};             ///< JSON of speed against error; empty for none
  bool stale = false;                     ///< files made before a change of the scene are shown too
};

/// Declares the subcommand `report` of `app`; the values are in `arguments` after parsing.
void declare_report(CLI::App& app, ReportArguments& arguments);

/// The files of a scene, as input of a report.
struct ReportSource {
  scene::Scene scene;
  std::filesystem::path folder;
  Stale stale = Stale::refuse;
};

/// One self-contained page of what is in the folder: the body, the certificate of its reduction,
/// the results of squeal and the sound. Needs no PETSc.
/// @param benchmark  JSON text that the page draws too, or "null"
/// @throws chladni::Error when there is neither a body nor results, or a file is damaged.
std::string report_html(const ReportSource& source, std::string_view benchmark);

/// The same of some runs: what differs between them, then all of one run, which the reader chooses.
std::string comparison_html(const std::vector<ReportSource>& sources, std::string_view benchmark);

/// Makes the page of one run, NAME.report.html in its folder, or of some, NAME.comparison.html in
/// that of the first.
/// @throws chladni::Error as report_html, and when the scene or the benchmark cannot be read.
void write_report(const ReportArguments& arguments);

/// The runs that the arguments name: scene i with its files in folder i. One scene goes with all
/// folders, and one folder with all scenes.
/// @throws chladni::Error when there are some of both and not as many, or a scene cannot be read.
std::vector<ReportSource> runs_of(const ReportArguments& arguments);

/// What tells the runs from each other: their titles, folders or scene files, the first of which
/// that all differ; else all of it.
std::vector<std::string> labels_of(const std::vector<ReportSource>& sources);

/// Frequency responses as a page: amplitude and phase of the outputs for each load, and tables.
/// Only the 24 largest outputs are drawn, and the page says so.
std::string responses_page(const mbs_export::FrequencyResponses& responses);

}  // namespace chladni::report
