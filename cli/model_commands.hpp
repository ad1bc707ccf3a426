#pragma once

#include <string>

#include "cli/chladni_commands.hpp"

namespace CLI {

class App;

}  // namespace CLI

namespace chladni::cli {

/// The option --length-unit of a command that reads a file without a unit of its own.
void declare_length_unit(CLI::App& app, std::string& unit);

/// The subcommand `mac`.
void declare_mac(CLI::App& app, MacArguments& arguments);

/// The options of `response` besides those of all commands on scenes.
void declare_response(CLI::App& response, ResponseChoice& choice);

}  // namespace chladni::cli
