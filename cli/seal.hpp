#pragma once

#include <string>

namespace CLI {
class App;
}

namespace chladni::cli {

/// What `seal` takes.
struct SealArguments {
  std::string file;
  bool detach = false;  ///< the seal goes into FILE.seal, and FILE is HDF5 from its first byte on
};

/// Declares the subcommand `seal` of `app`.
void declare_seal(CLI::App& app, SealArguments& arguments);

/// Accepts a file that was changed on purpose (files/seal.hpp), and says so.
/// @throws chladni::Error when libhdf5 cannot open it, or it cannot be written.
void seal(const SealArguments& arguments);

}  // namespace chladni::cli
