#pragma once

#include <petscsys.h>

#include <optional>
#include <string>

/// How a reduction is computed, as values: nothing here is looked up while it runs.
namespace chladni::linear {

/// Where PETSc's own objects inside (KSP, PC, EPS, MUMPS) find their options.
struct OptionSource {
  PetscOptions database = nullptr;  ///< nullptr: PETSc's global one; must outlive its users
  std::string prefix = "cms_";      ///< options are named `-<prefix>pc_...`
  /// For a solver inside, whose options are named `-<prefix><name>...`.
  OptionSource part(const char* name) const { return {database, prefix + name}; }
  bool operator==(const OptionSource&) const = default;
};

/// A factor of another matrix with the same pattern, which is there for a while beside the first.
struct SecondFactor {
  double entries = 0.0;     ///< in multiples of the first one's
  double beside_MiB = 0.0;  ///< what else this rank has then
  bool operator==(const SecondFactor&) const = default;
};

struct FactorOptions {
  std::optional<double> memory_MiB = {};  ///< of each machine; by default what is free there
  double beside_MiB = 0.0;  ///< what this rank takes later, while the factor alone is there
  SecondFactor second = {};
  bool is_least = false;  ///< more may come beside it than can be foreseen
  bool operator==(const FactorOptions&) const = default;
};

enum class ModeSolver { block_lanczos, krylov_schur };

/// How the fixed-interface modes are found; block size and subspace are of block Lanczos.
struct LanczosOptions {
  ModeSolver solver = ModeSolver::block_lanczos;
  PetscInt block_size = 8;  ///< a panel of the factor; wider blocks need more columns
  PetscInt subspace = 0;    ///< basis vectors before a restart; 0 = as many as suit
  double tolerance = 1e-7;  ///< of the vectors; the error of lambda is its square
  bool operator==(const LanczosOptions&) const = default;
};

struct SolverOptions {
  OptionSource petsc = {};
  FactorOptions factor = {};
  LanczosOptions lanczos = {};
  bool operator==(const SolverOptions&) const = default;
};

}  // namespace chladni::linear
