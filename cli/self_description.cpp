#include "cli/self_description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <vector>

#include "report/version.hpp"

namespace chladni::cli {
namespace {

using Lines = std::vector<std::string>;

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

std::string in_single_quotes(const std::string& text)
{
  return "'" + replaced(text, "'", "'\\''") + "'";
}

std::vector<const CLI::App*> subcommands(const CLI::App& app)
{
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Those with a name of two dashes: "--output".
std::vector<const CLI::Option*> options(const CLI::App& app)
{
  return app.get_options([](const CLI::Option* option) { return !option->get_lnames().empty(); });
}

bool takes_value(const CLI::Option& option)
{
  return option.get_items_expected_max() > 0 && option.get_type_size() > 0;
}

std::string long_name(const CLI::Option& option)
{
  return "--" + option.get_lnames().front();
}

std::string joined(const Lines& words, const std::string& between)
{
  return fmt::format("{}", fmt::join(words, between));
}

Lines option_names(const CLI::App& app)
{
  Lines names;
  for (const CLI::Option* option : options(app)) names.push_back(long_name(*option));
  return names;
}

std::string bash(const CLI::App& app)
{
  const std::string& name = app.get_name();
  Lines names, cases;
  for (const CLI::App* part : subcommands(app)) {
    names.push_back(part->get_name());
    cases.push_back(fmt::format("    {}) options=\"{}\" ;;", part->get_name(),
                                joined(option_names(*part), " ")));
  }
  return fmt::format(
      "_{0}()\n"
      "{{\n"
      "  local word=\"${{COMP_WORDS[COMP_CWORD]}}\" options=\"{1}\" i\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    case \"${{COMP_WORDS[i]}}\" in\n{2}\n    esac\n"
      "  done\n"
      "  case \"${{COMP_WORDS[COMP_CWORD-1]}}\" in\n"
      "    --output|--from) COMPREPLY=($(compgen -d -- \"$word\")); return ;;\n"
      "  esac\n"
      "  if [[ $word == -* || $COMP_CWORD -eq 1 ]]; then\n"
      "    [[ $COMP_CWORD -eq 1 ]] && options+=\" {3}\"\n"
      "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
      "  else\n"
      "    COMPREPLY=($(compgen -f -- \"$word\"))\n"
      "  fi\n"
      "}}\n"
      "complete -o filenames -F _{0} {0}\n",
      name, joined(option_names(app), " "), joined(cases, "\n"), joined(names, " "));
}

/// In zsh's `_arguments`: '--output[folder for the files]:DIR:_files'.
std::string zsh_option(const CLI::Option& option)
{
  std::string text = option.get_description();
  for (const char* special : {"[", "]", ":"}) text = replaced(text, special, " ");
  const std::string value = takes_value(option) ? ":value:_files" : "";
  return "      " + in_single_quotes(fmt::format("{}[{}]{}", long_name(option), text, value));
}

std::string zsh(const CLI::App& app)
{
  const std::string& name = app.get_name();
  Lines descriptions, cases;
  for (const CLI::App* part : subcommands(app)) {
    descriptions.push_back("    " + in_single_quotes(part->get_name() + ":" +
                                                     replaced(part->get_description(), ":", " -")));
    Lines words;
    for (const CLI::Option* option : options(*part)) words.push_back(zsh_option(*option));
    words.emplace_back("      '*:file:_files'");
    cases.push_back(
        fmt::format("    {}) _arguments \\\n{} ;;", part->get_name(), joined(words, " \\\n")));
  }
  return fmt::format(
      "#compdef {0}\n"
      "_{0}()\n"
      "{{\n"
      "  local -a subcommands=(\n{1}\n  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe subcommand subcommands\n"
      "    return\n"
      "  fi\n"
      "  local subcommand=$words[2]\n"
      "  (( --CURRENT ))\n"
      "  shift words\n"
      "  case $subcommand in\n{2}\n  esac\n"
      "}}\n"
      "if [[ $funcstack[1] == _{0} ]]; then _{0} \"$@\"; else compdef _{0} {0}; fi\n",
      name, joined(descriptions, "\n"), joined(cases, "\n"));
}

std::string fish(const CLI::App& app)
{
  const std::string& name = app.get_name();
  std::string text;
  for (const CLI::App* part : subcommands(app)) {
    text += fmt::format("complete -c {} -n __fish_use_subcommand -f -a {} -d {}\n", name,
                        part->get_name(), in_single_quotes(part->get_description()));
    for (const CLI::Option* option : options(*part)) {
      text += fmt::format("complete -c {} -n '__fish_seen_subcommand_from {}' -l {}{} -d {}\n",
                          name, part->get_name(), option->get_lnames().front(),
                          takes_value(*option) ? " -r" : "",
                          in_single_quotes(option->get_description()));
    }
  }
  return text;
}

/// Text in which troff sees no command.
std::string troff(const std::string& text)
{
  std::string escaped = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  escaped = replaced(escaped, "\n.", "\n\\&.");
  return replaced(escaped, "\n'", "\n\\&'");
}

std::string troff_option(const CLI::Option& option)
{
  const bool is_positional = option.get_lnames().empty();
  std::string head = is_positional ? option.get_name() : "\\fB" + troff(long_name(option)) + "\\fR";
  if (!is_positional && takes_value(option)) head += " \\fI" + option.get_type_name() + "\\fR";
  std::string text = option.get_description();
  if (!option.get_default_str().empty())
    text += fmt::format(" (default: {})", option.get_default_str());
  return fmt::format(".TP\n{}\n{}\n", head, troff(text));
}

std::string troff_footer(const std::string& footer)
{
  return fmt::format(".PP\n.nf\n{}\n.fi\n", troff(footer));
}

}  // namespace

std::string manual_page(const CLI::App& app)
{
  const std::string& name = app.get_name();
  std::string text = fmt::format(
      ".TH {} 1 \"\" \"{}\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n\\fB{}\\fR \\fISUBCOMMAND\\fR "
      "[\\fIARGUMENTS\\fR]\n",
      name, report::version, name, troff(app.get_description()), name);
  text += ".SH OPTIONS\n";
  for (const CLI::Option* option : options(app)) text += troff_option(*option);
  text += ".SH SUBCOMMANDS\n";
  for (const CLI::App* part : subcommands(app)) {
    text += fmt::format(".SS {} {}\n{}\n", name, troff(part->get_name()),
                        troff(part->get_description()));
    for (const CLI::Option* option : part->get_options([](auto*) { return true; }))
      text += troff_option(*option);
    if (!part->get_footer().empty()) text += troff_footer(part->get_footer());
  }
  return text + ".SH NOTES" + "\n" + troff_footer(app.get_footer());
}

std::string completion_script(const CLI::App& app, const std::string& shell)
{
  return shell == "bash" ? bash(app) : shell == "zsh" ? zsh(app) : fish(app);
}

void declare_self_description(CLI::App& app, SelfDescription& arguments)
{
  CLI::App* completion =
      app.add_subcommand("completion", "prints a script for command completion in a shell");
  completion->add_option("SHELL", arguments.shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion->footer(fmt::format(
      "Example (installed packages have it):\n  source <({} completion bash)", app.get_name()));
  app.add_subcommand("manual", "prints the manual page as source for `man`")
      ->footer(fmt::format("Example:\n  {0} manual > {0}.1; man ./{0}.1", app.get_name()));
}

bool describe_itself(const CLI::App& app, const SelfDescription& arguments)
{
  if (app.got_subcommand("completion"))
    fmt::print("{}", completion_script(app, arguments.shell));
  else if (app.got_subcommand("manual"))
    fmt::print("{}", manual_page(app));
  else
    return false;
  return true;
}

}  // namespace chladni::cli
