#include "cli/seal.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "common/files/seal.hpp"

namespace chladni::cli {

void declare_seal(CLI::App& app, SealArguments& arguments)
{
  CLI::App* seal = app.add_subcommand("seal", "accepts a file that was changed on purpose");
  seal->add_option("FILE", arguments.file,
                   "a *.h5 of Chladni that another program has changed or made")
      ->required();
  seal->footer(fmt::format(
      "Chladni refuses a file that was changed after it was written; `seal` accepts its present "
      "content.\nExample:\n  {} seal out/disc.body.h5",
      app.get_name()));
}

void seal(const SealArguments& arguments)
{
  files::seal_file(arguments.file);
  fmt::print("{}: sealed as it is now; what it holds was not checked\n", arguments.file);
}

}  // namespace chladni::cli
