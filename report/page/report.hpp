#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "report/origin.hpp"
#include "scene/scene.hpp"

namespace CLI {
class App;
}

namespace chladni::report {

/// Arguments of `chladni report` and `squeal report`.
struct ReportArguments {
  std::string scene;
  std::string output = ".";  ///< folder of the scene's files and of the report
  std::string benchmark;     ///< JSON file of a benchmark, speed against error; empty for none
  bool stale = false;        ///< show files that were made before the scene changed
};

/// Declares the subcommand `report` of `app`; the values are in `arguments` after parsing.
void declare_report(CLI::App& app, ReportArguments& arguments);

/// The files of a scene, as input of a report.
struct ReportSource {
  scene::Scene scene;
  std::filesystem::path folder;
  Stale stale = Stale::refuse;
};

/// One self-contained HTML page about the files in the folder: the body, the certificate of its
/// reduction and the results of squeal. Needs no PETSc.
/// @param benchmark  JSON text of a benchmark to draw as well, or "null"
/// @throws chladni::Error when there is neither a body nor a result, or a file is damaged.
std::string report_html(const ReportSource& source, std::string_view benchmark);

/// Writes the page of report_html to NAME.report.html in the folder.
/// @throws chladni::Error as report_html, and when the scene or the benchmark cannot be read.
void write_report(const ReportArguments& arguments);

}  // namespace chladni::report
