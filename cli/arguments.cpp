#include "cli/arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "report/text_table.hpp"
#include "scene/keys.hpp"

namespace chladni::cli {

void declare_scene_arguments(CLI::App& app, SceneArguments& arguments)
{
  app.add_option("SCENE", arguments.scene, "the scene file (TOML)")->required();
  app.add_option("--output", arguments.output, "folder of the input and output files")
      ->type_name("DIR")
      ->capture_default_str();
  app.add_option("--json", arguments.json, "writes the summary as JSON")->type_name("FILE");
  app.add_flag("--overwrite", arguments.overwrite,
               "replaces files that another scene with the same `name` wrote");
  app.add_flag("--quiet", arguments.quiet, "prints only notes and errors, no results");
}

void declare_stale(CLI::App& app, bool& stale)
{
  app.add_flag("--stale", stale, "uses files that were made before the scene changed");
}

namespace {

/// What this program, or the subcommand that was given, knows by name.
std::vector<std::string> known_words(const CLI::App& app)
{
  std::vector<std::string> words;
  for (const CLI::App* part : app.get_subcommands({})) words.push_back(part->get_name());
  for (const CLI::App* part : app.get_subcommands())
    for (const CLI::Option* option : part->get_options()) words.push_back(option->get_name());
  return words;
}

/// `; did you mean --output?` for the first of the words that nobody knows.
std::string suggestion(const CLI::App& app, const std::vector<std::string>& words)
{
  const std::vector<std::string> known = known_words(app);
  for (const std::string& word : words) {
    if (std::ranges::find(known, word) != known.end()) continue;
    const std::string near = scene::nearest_name(word, known);
    if (!near.empty()) return fmt::format("; did you mean {}?", near);
  }
  return "";
}

}  // namespace

std::optional<int> parse_arguments(CLI::App& app, std::vector<std::string> words)
{
  const std::vector<std::string> said = words;
  std::ranges::reverse(words);  // CLI11 takes them from the end
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    const std::string near = suggestion(app, said);
    if (error.get_exit_code() == 0 || near.empty())
      return app.exit(error) == 0 ? exit_ok : exit_usage;
    app.exit(CLI::ConversionError(error.what() + report::printable(near)));
    return exit_usage;
  }
  return std::nullopt;
}

}  // namespace chladni::cli
