#pragma once

#include <string>

namespace CLI {
class App;
}

namespace chladni::cli {

/// Arguments of the subcommand `seal`.
struct SealArguments {
  std::string file;
};

/// Declares the subcommand `seal` of `app`.
void declare_seal(CLI::App& app, SealArguments& arguments);

/// Seals a file that was changed on purpose (common/files/seal.hpp), and prints that.
/// @throws chladni::Error when libhdf5 cannot open the file or it cannot be written.
void seal(const SealArguments& arguments);

}  // namespace chladni::cli
