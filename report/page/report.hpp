#pragma once

#include <string>

namespace CLI {
class App;
}

namespace chladni::report {

/// What `chladni report` and `squeal report` take.
struct ReportArguments {
  std::string scene;
  std::string output = ".";  ///< folder of the scene's files, and of the report
  std::string benchmark;     ///< JSON of speed against error; empty for none
  bool stale = false;        ///< files made before a change of the scene are shown too
};

/// Declares the subcommand `report` of `app`; the values arrive in `arguments`.
void declare_report(CLI::App& app, ReportArguments& arguments);

/// Makes one self-contained page, NAME.report.html, of what is in the folder: the body, the
/// certificate of its reduction and the results of squeal. Needs no PETSc.
/// @throws chladni::Error when there is neither a body nor results, or a file is damaged.
void write_report(const ReportArguments& arguments);

}  // namespace chladni::report
