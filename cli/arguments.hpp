#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace chladni::cli {

/// Exit codes of the programs.
inline constexpr int exit_ok = 0;
inline constexpr int exit_failed = 1;
inline constexpr int exit_usage = 2;

/// Arguments of every subcommand that works on a scene.
struct SceneArguments {
  std::string scene;         ///< the scene file
  std::string output = ".";  ///< folder of the output files
  std::string json;          ///< file for the JSON summary; empty for none
  bool stale = false;        ///< use input files that were made before the scene changed
  bool overwrite = false;    ///< replace output files that another scene wrote under the same name
  bool quiet = false;        ///< print notes and errors only, no results and no progress
};

/// Declares SCENE, --output, --json, --overwrite and --quiet. The values are in `arguments` after
/// `app` is parsed.
void declare_scene_arguments(CLI::App& app, SceneArguments& arguments);

/// Declares --stale, for subcommands that read files made by other subcommands.
void declare_stale(CLI::App& app, bool& stale);

/// Parses the words after the program's name and prints help, version or the error of a wrong word.
/// @return the exit code when the program shall end, else nothing
std::optional<int> parse_arguments(CLI::App& app, std::vector<std::string> words);

}  // namespace chladni::cli
