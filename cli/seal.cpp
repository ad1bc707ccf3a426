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
  seal->add_flag("--detach", arguments.detach,
                 "writes the seal to FILE.seal, so that FILE is plain HDF5 from its first byte");
  seal->footer(fmt::format(
      "Chladni refuses a file that was changed after it was written; `seal` accepts its present "
      "content.\nSome readers of HDF5 (pyfive, jsfive) need the HDF5 signature at the first byte: "
      "use --detach.\nExamples:\n  {0} seal out/disc.body.h5\n  {0} seal --detach out/disc.body.h5",
      app.get_name()));
}

void seal(const SealArguments& arguments)
{
  const std::string& file = arguments.file;
  files::seal_file(file, arguments.detach ? files::SealPlace::beside : files::SealPlace::inside);
  const std::string where =
      arguments.detach ? fmt::format(", by {}", files::detached_seal(file)) : "";
  fmt::print("{}: sealed as it is now{}; what it holds was not checked\n", file, where);
}

}  // namespace chladni::cli
