#pragma once

#include <petscsys.h>

#include <optional>
#include <string>

/// Options of a reduction as values: no option is looked up while it runs.

namespace chladni::linear {

/// Where PETSc's objects inside (KSP, PC, EPS, MUMPS) find their options.
struct OptionSource {
  PetscOptions database = nullptr;  ///< nullptr: PETSc's global one; must outlive its users
  std::string prefix = "cms_";      ///< options are named `-<prefix>pc_...`
  /// The source for an inner solver, whose options are named `-<prefix><name>...`.
  OptionSource part(const char* name) const { return {database, prefix + name}; }
  bool operator==(const OptionSource&) const = default;
};

/// A temporary factor of another matrix with the same pattern, beside the first one.
struct SecondFactor {
  double entries = 0.0;     ///< in multiples of those of the first
  double beside_MiB = 0.0;  ///< other memory of this rank at that time
  bool operator==(const SecondFactor&) const = default;
};

struct FactorOptions {
  /// limit for each machine; by default what is free there
  std::optional<double> memory_MiB = {};
  /// What this rank takes later, after the factorisation, while the factor stays.
  double beside_MiB = 0.0;
  SecondFactor second = {};
  bool is_least = false;  ///< true if later needs may exceed `beside_MiB`
  bool operator==(const FactorOptions&) const = default;
};

enum class ModeSolver { block_lanczos, krylov_schur };

/// The solver for fixed-interface modes; block size and subspace are for block Lanczos.
struct LanczosOptions {
  ModeSolver solver = ModeSolver::block_lanczos;
  PetscInt block_size = 8;  ///< a panel of the factor; wider blocks need more columns
  PetscInt subspace = 0;    ///< largest basis before a restart; 0 = chosen automatically
  double tolerance = 1e-7;  ///< of the vectors; the error of lambda is its square
  bool operator==(const LanczosOptions&) const = default;
};

struct SolverOptions {
  OptionSource petsc = {};
  FactorOptions factor = {};
  LanczosOptions lanczos = {};
  /// folder for files that hold modes, constraint modes, the basis of block Lanczos and the blocks
  /// of the slaves; empty: they are in memory
  std::string scratch = {};
  bool operator==(const SolverOptions&) const = default;
};

/// Reads the options of the reduction that do not belong to PETSc's own objects, and lists them for
/// -help. Options that are not given keep the values of `defaults`.
/// @param defaults  its `petsc` also says where the options are read from
/// @note   Collective on `comm`.
/// @throws chladni::Error on all ranks for an invalid value.
/// Options: `-<prefix>memory <MiB>`, `-<prefix>modes_solver block-lanczos|krylov-schur`,
/// `-<prefix>lanczos_block_size`, `-<prefix>lanczos_subspace`, `-<prefix>lanczos_tolerance`
SolverOptions read_solver_options(MPI_Comm comm, const SolverOptions& defaults = {});

}  // namespace chladni::linear
