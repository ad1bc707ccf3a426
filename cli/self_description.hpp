#pragma once

#include <string>

namespace CLI {
class App;
}

namespace chladni::cli {

/// What `completion` and `manual` take.
struct SelfDescription {
  std::string shell;
};

/// Declares the subcommands `completion` and `manual` of `app`.
void declare_self_description(CLI::App& app, SelfDescription& arguments);

/// Prints what one of the two was asked for, from the same declarations as --help.
/// @return whether one of them was.
bool describe_itself(const CLI::App& app, const SelfDescription& arguments);

/// A script for "bash", "zsh" or "fish" that completes subcommands, options and files.
std::string completion_script(const CLI::App& app, const std::string& shell);

/// The page that `man` shows.
std::string manual_page(const CLI::App& app);

}  // namespace chladni::cli
