#pragma once

#include <functional>
#include <string>
#include <vector>

namespace chladni::cli {

/// PETSc, SLEPc and MPI, from construction to destruction. Failures of PETSc come back as error
/// codes and print nothing.
class PetscSession {
 public:
  /// @param options  PETSc options as words, "-name" "value" ...
  /// @throws chladni::Error when PETSc refuses them.
  explicit PetscSession(const std::vector<std::string>& options);
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;
};

/// Of this process among those that mpirun started.
int rank();
int n_ranks();

/// Over all ranks. @note Collective.
double sum_over_ranks(double x);
double largest_of_ranks(double x);

/// Performs `work` on the first rank, while the others wait for it.
/// @throws chladni::Error on all ranks, with the text of what `work` threw on the first.
/// @note   Collective.
void on_first_rank(const std::function<void()>& work);

/// Ends all ranks with this exit code, without waiting for them.
[[noreturn]] void abort_all_ranks(int exit_code);

}  // namespace chladni::cli
