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

/// What all subcommands that work on a scene take.
struct SceneArguments {
  std::string scene;         ///< the scene file
  std::string output = ".";  ///< folder for the files
  std::string json;          ///< file for the summary; empty for none
  bool stale = false;        ///< files made before a change of the scene are taken as they are
  bool overwrite = false;    ///< files of another scene of the same name may be replaced
  bool quiet = false;        ///< no results and no progress, only notes and errors
};

/// Declares SCENE, --output, --json, --overwrite and --quiet; the values arrive in `arguments` when
/// `app` is parsed.
void declare_scene_arguments(CLI::App& app, SceneArguments& arguments);

/// Declares --stale, for subcommands that read what others made of the scene.
void declare_stale(CLI::App& app, bool& stale);

/// Parses the words that follow the name of the program, and prints help, version or complaint.
/// @return the exit code, when there is nothing left to do.
std::optional<int> parse_arguments(CLI::App& app, std::vector<std::string> words);

}  // namespace chladni::cli
