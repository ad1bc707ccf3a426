#pragma once

#include <array>

namespace chladni::mesh {

/// Nothing is written to stdout and stderr while it lives: Gmsh's recombination prints warnings of
/// its own workings there, whatever General.Terminal says.
class SilentOutput {
 public:
  SilentOutput();
  ~SilentOutput();
  SilentOutput(const SilentOutput&) = delete;
  SilentOutput& operator=(const SilentOutput&) = delete;

 private:
  std::array<int, 2> saved_;  ///< descriptors of both; -1 where there was none
};

}  // namespace chladni::mesh
