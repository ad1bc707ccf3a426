#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "cli/arguments.hpp"
#include "cli/seal.hpp"
#include "cli/self_description.hpp"
#include "cli/squeal_commands.hpp"
#include "common/files/hdf5.hpp"
#include "common/files/output_file.hpp"
#include "report/describe_body.hpp"
#include "report/page/pages.hpp"
#include "report/progress.hpp"
#include "report/text_table.hpp"
#include "report/timing.hpp"
#include "report/version.hpp"
#include "scene/keys.hpp"

namespace {

namespace cli = chladni::cli;

struct SquealArguments {
  chladni::cli::RunArguments run;
  chladni::cli::SweepArguments sweep;
  chladni::cli::CondenseArguments condense;
  std::string info_file;
  chladni::cli::SealArguments seal;
  chladni::cli::SelfDescription self;
  chladni::report::ReportArguments report;
};

void declare_run(CLI::App& app, SquealArguments& arguments)
{
  CLI::App* run = app.add_subcommand(
      "run", "performs the analyses of the scene's [squeal] on a body: NAME.squeal.h5");
  chladni::cli::declare_scene_arguments(*run, arguments.run.scene);
  chladni::cli::declare_stale(*run, arguments.run.scene.stale);
  run->add_flag("--resume", arguments.run.resume,
                "keeps the analyses that an interrupted run has finished");
  run->add_option("--body", arguments.run.body_file, "body file; default: NAME.body.h5 in DIR")
      ->type_name("FILE");
  run->footer(
      "Examples:\n"
      "  squeal run scene.toml                             ./disc.body.h5 -> ./disc.squeal.h5\n"
      "  squeal run scene.toml --output out --json s.json  out/disc.body.h5 -> out/disc.squeal.h5\n"
      "  squeal run scene.toml --body other.body.h5        another body, the same pads\n"
      "  squeal run scene.toml --resume                    after a run that was killed");
}

void declare_info(CLI::App& app, SquealArguments& arguments)
{
  CLI::App* info = app.add_subcommand("info", "prints what a body or result file contains");
  info->add_option("FILE", arguments.info_file, "*.body.h5, *.squeal.h5 or *.sweep.h5")->required();
  info->footer("Example:\n  squeal info out/disc.squeal.h5");
}

}  // namespace

int main(int argc, char** argv)
{
  chladni::report::keep_freed_memory();
  SquealArguments arguments;
  CLI::App app("Brake squeal of a modal body: stability, growth, transients and limit cycles.",
               "squeal");
  app.set_version_flag("--version", fmt::format("squeal {}", chladni::report::version));
  app.require_subcommand(1);
  declare_run(app, arguments);
  chladni::cli::declare_sweep(app, arguments.sweep);
  chladni::cli::declare_condense(app, arguments.condense);
  declare_info(app, arguments);
  chladni::report::declare_report(app, arguments.report);
  chladni::cli::declare_seal(app, arguments.seal);
  chladni::cli::declare_self_description(app, arguments.self);
  app.add_subcommand("scene-reference", "prints every key of a scene file, in Markdown")
      ->footer("Example:\n  squeal scene-reference > scene_reference.md");
  app.footer(
      "Examples:\n  squeal run scene.toml --output out\n"
      "  squeal sweep scene.toml --vary squeal.friction=0.3:0.6:10 --output out\n  squeal info "
      "out/disc.squeal.h5\n"
      "  squeal report scene.toml --output out");
  if (const auto code = chladni::cli::parse_arguments(app, {argv + 1, argv + argc})) return *code;
  if (arguments.run.scene.quiet || arguments.sweep.scene.quiet || arguments.condense.scene.quiet)
    chladni::report::be_quiet();
  chladni::files::leave_nothing_to_exit();
  chladni::files::remove_unfinished_files_on_signals();
  try {
    if (app.got_subcommand("run"))
      chladni::cli::run_squeal(arguments.run);
    else if (app.got_subcommand("sweep"))
      chladni::cli::run_sweep(arguments.sweep);
    else if (app.got_subcommand("condense"))
      chladni::cli::run_condense(arguments.condense);
    else if (app.got_subcommand("report"))
      chladni::report::write_report(arguments.report);
    else if (app.got_subcommand("seal"))
      chladni::cli::seal(arguments.seal);
    else if (app.got_subcommand("scene-reference"))
      fmt::print("{}", chladni::scene::scene_reference());
    else if (!chladni::cli::describe_itself(app, arguments.self))
      fmt::print("{}", chladni::report::describe_file(arguments.info_file));
    chladni::report::finish_printing();
    return chladni::cli::exit_ok;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", chladni::report::said(error));
    return chladni::cli::exit_failed;
  }
}
