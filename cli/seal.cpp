#include "cli/seal.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "files/seal.hpp"

namespace chladni::cli {

void declare_seal(CLI::App& app, std::string& file)
{
  CLI::App* seal = app.add_subcommand("seal", "accepts a file that was changed on purpose");
  seal->add_option("FILE", file, "a *.h5 of Chladni that another program has changed or made")
      ->required();
  seal->footer(
      fmt::format("A file that is not as it was written is refused. This accepts it as it is now.\n"
                  "Example:\n  {} seal out/disc.body.h5",
                  app.get_name()));
}

void seal(const std::string& file)
{
  files::seal_file(file);
  fmt::print("{}: sealed as it is now; what it holds was not checked\n", file);
}

}  // namespace chladni::cli
