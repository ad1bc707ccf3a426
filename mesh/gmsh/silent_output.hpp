#pragma once

#include <array>

namespace chladni::mesh {

/// Suppresses output to stdout and stderr during its lifetime. Gmsh's recombination prints warnings
/// there whatever General.Terminal says.
class SilentOutput {
 public:
  SilentOutput();
  ~SilentOutput();
  SilentOutput(const SilentOutput&) = delete;
  SilentOutput& operator=(const SilentOutput&) = delete;

 private:
  std::array<int, 2> saved_;  ///< descriptors of both; -1 for one that was closed
};

}  // namespace chladni::mesh
