#pragma once

#include <string>

namespace CLI {
class App;
}

namespace chladni::cli {

/// Arguments of `completion` and `manual`.
struct SelfDescription {
  std::string shell;  ///< "bash", "zsh" or "fish"
};

/// Declares the subcommands `completion` and `manual` of `app`.
void declare_self_description(CLI::App& app, SelfDescription& arguments);

/// Prints the completion script or the manual page if one was asked for, made from the same
/// declarations as --help.
/// @return whether one was asked for
bool describe_itself(const CLI::App& app, const SelfDescription& arguments);

/// A script for "bash", "zsh" or "fish" that completes subcommands, options and file names.
std::string completion_script(const CLI::App& app, const std::string& shell);

/// The manual page, as source for `man`.
std::string manual_page(const CLI::App& app);

}  // namespace chladni::cli
