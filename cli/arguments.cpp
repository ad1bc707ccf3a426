#include "cli/arguments.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace chladni::cli {

void declare_scene_arguments(CLI::App& app, SceneArguments& arguments)
{
  app.add_option("SCENE", arguments.scene, "the scene file (TOML)")->required();
  app.add_option("--output", arguments.output, "folder for the files")
      ->type_name("DIR")
      ->capture_default_str();
  app.add_option("--json", arguments.json, "writes the summary for other programs")
      ->type_name("FILE");
  app.add_flag("--overwrite", arguments.overwrite,
               "replaces files that another scene of the same `name` wrote");
}

void declare_stale(CLI::App& app, bool& stale)
{
  app.add_flag("--stale", stale, "takes files that were made before the scene changed");
}

std::optional<int> parse_arguments(CLI::App& app, std::vector<std::string> words)
{
  std::reverse(words.begin(), words.end());  // CLI11 takes them from the end
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_ok : exit_usage;
  }
  return std::nullopt;
}

}  // namespace chladni::cli
