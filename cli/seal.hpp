#pragma once

#include <string>

namespace CLI {
class App;
}

namespace chladni::cli {

/// Declares the subcommand `seal` of `app`; its file arrives in `file`.
void declare_seal(CLI::App& app, std::string& file);

/// Accepts a file that was changed on purpose (files/seal.hpp), and says so.
/// @throws chladni::Error when libhdf5 cannot open it, or it cannot be written.
void seal(const std::string& file);

}  // namespace chladni::cli
