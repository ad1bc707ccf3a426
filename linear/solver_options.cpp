#include "linear/solver_options.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "common/petsc.hpp"

namespace chladni::linear {

namespace {

constexpr std::array<std::string_view, 2> solver_names{"block-lanczos", "krylov-schur"};
constexpr std::array solvers{ModeSolver::block_lanczos, ModeSolver::krylov_schur};

/// Values as the options say them.
struct Said {
  PetscReal memory_MiB = 0.0;
  std::array<char, 64> solver{};
  std::array<char, PETSC_MAX_PATH_LEN> scratch{};
  LanczosOptions lanczos;
};

PetscErrorCode ask(MPI_Comm comm, const OptionSource& source, Said& said)
{
  LanczosOptions& lanczos = said.lanczos;
  PetscFunctionBegin;
  PetscOptionsBegin(comm, source.prefix.c_str(), "Solvers of a reduction", "CMS");
  PetscOptionsObject->options = source.database;
  PetscCall(PetscOptionsReal("-memory", "MiB of each machine for the factor; 0: what is free",
                             nullptr, said.memory_MiB, &said.memory_MiB, nullptr));
  PetscCall(PetscOptionsString("-scratch", "Folder for files of modes and constraint modes",
                               nullptr, said.scratch.data(), said.scratch.data(),
                               said.scratch.size(), nullptr));
  PetscCall(PetscOptionsString("-modes_solver", "block-lanczos or krylov-schur", nullptr,
                               said.solver.data(), said.solver.data(), said.solver.size(),
                               nullptr));
  PetscCall(PetscOptionsInt("-lanczos_block_size", "Columns solved at a time", nullptr,
                            lanczos.block_size, &lanczos.block_size, nullptr));
  PetscCall(PetscOptionsInt("-lanczos_subspace", "Basis vectors before a restart; 0: as suits",
                            nullptr, lanczos.subspace, &lanczos.subspace, nullptr));
  PetscCall(PetscOptionsReal("-lanczos_tolerance",
                             "Residual of the modes; the error of lambda is its square", nullptr,
                             lanczos.tolerance, &lanczos.tolerance, nullptr));
  PetscOptionsEnd();
  PetscFunctionReturn(0);
}

void refuse_nonsense(const Said& said, const std::string& prefix)
{
  if (std::ranges::find(solver_names, said.solver.data()) == solver_names.end()) {
    throw Error(fmt::format("-{}modes_solver {}: give {} or {}", prefix, said.solver.data(),
                            solver_names[0], solver_names[1]));
  }
  const LanczosOptions& lanczos = said.lanczos;
  if (lanczos.block_size < 1 || lanczos.subspace < 0 || !(lanczos.tolerance > 0.0)) {
    throw Error(fmt::format(
        "-{0}lanczos_block_size {1}, -{0}lanczos_subspace {2}, -{0}lanczos_tolerance {3:g}: give "
        "positive values",
        prefix, lanczos.block_size, lanczos.subspace, lanczos.tolerance));
  }
  if (!(said.memory_MiB >= 0.0)) {
    throw Error(
        fmt::format("-{}memory {:g}: give MiB, or 0 for what is free", prefix, said.memory_MiB));
  }
}

/// On all ranks when files cannot be written there on one.
void refuse_no_folder(const std::string& folder, const std::string& prefix, MPI_Comm comm)
{
  std::error_code ignored;
  const bool is_folder = std::filesystem::is_directory(folder, ignored);
  int refused = is_folder && access(folder.c_str(), W_OK) == 0 ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &refused, 1, MPI_INT, MPI_MAX, comm);
  if (refused == 0) return;
  throw Error(fmt::format(
      "-{}scratch {}: files cannot be written there; give an existing folder on a disk of each "
      "machine",
      prefix, folder));
}

}  // namespace

SolverOptions read_solver_options(MPI_Comm comm, const SolverOptions& defaults)
{
  Said said{.memory_MiB = defaults.factor.memory_MiB.value_or(0.0),
            .solver = {},
            .scratch = {},
            .lanczos = defaults.lanczos};
  std::ranges::copy(solver_names[std::ranges::find(solvers, said.lanczos.solver) - solvers.begin()],
                    said.solver.begin());
  if (defaults.scratch.size() < said.scratch.size())
    std::ranges::copy(defaults.scratch, said.scratch.begin());
  petsc::check(ask(comm, defaults.petsc, said));
  refuse_nonsense(said, defaults.petsc.prefix);
  SolverOptions options{.petsc = defaults.petsc,
                        .factor = defaults.factor,
                        .lanczos = said.lanczos,
                        .scratch = said.scratch.data()};
  if (!options.scratch.empty()) refuse_no_folder(options.scratch, defaults.petsc.prefix, comm);
  const auto place = std::ranges::find(solver_names, said.solver.data()) - solver_names.begin();
  options.lanczos.solver = solvers[place];
  options.factor.memory_MiB.reset();
  if (said.memory_MiB > 0.0) options.factor.memory_MiB = said.memory_MiB;
  return options;
}

}  // namespace chladni::linear
