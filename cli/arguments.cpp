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

/// An option of version 0.2 that is no more, or one of its values, and what to do in its place.
struct GoneOption {
  std::string_view word, value, instead;
};

constexpr GoneOption gone_options[] = {
    {"--detach", "",
     "the seal is inside of the file; for a reader that wants HDF5 at byte 0, copy the groups to a "
     "file of their own (docs/reference/file_formats.md, The seal)"},
    {"--checkpoint", "",
     "a transient that was interrupted begins anew, and --resume keeps the analyses that are "
     "finished"},
    {"--format", "mat",
     "MATLAB reads the body file itself by h5read, and two lines of Python write a .mat for Octave "
     "(docs/how-to/read_a_body.md)"},
};

/// `; --WORD is gone: ...` for the first of the words that version 0.2 knew and this program does
/// not.
std::string told_of_gone(const CLI::App& app, const std::vector<std::string>& words)
{
  const std::vector<std::string> known = known_words(app);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::size_t end = words[i].find('=');
    const std::string word = words[i].substr(0, end);
    const std::string next = i + 1 < words.size() ? words[i + 1] : "";
    const std::string value = end == std::string::npos ? next : words[i].substr(end + 1);
    for (const auto& [gone, of, instead] : gone_options) {
      const bool is_it = of.empty() ? std::ranges::find(known, word) == known.end() : value == of;
      if (word == gone && is_it)
        return fmt::format("; {}{}{} is gone: {}", gone, of.empty() ? "" : " ", of, instead);
    }
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
    const std::string gone = told_of_gone(app, said);
    const std::string near = gone.empty() ? suggestion(app, said) : gone;
    if (error.get_exit_code() == 0 || near.empty())
      return app.exit(error) == 0 ? exit_ok : exit_usage;
    app.exit(CLI::ConversionError(error.what() + report::printable(near)));
    return exit_usage;
  }
  return std::nullopt;
}

}  // namespace chladni::cli
