#pragma once

#include <string>
#include <vector>

namespace chladni::cli {

/// PETSc, SLEPc and MPI are initialised from construction to destruction. PETSc returns its
/// failures as error codes and prints nothing.
class PetscSession {
 public:
  /// @param options  PETSc options as words, "-name" "value" ...
  /// @throws chladni::Error when PETSc refuses them.
  explicit PetscSession(const std::vector<std::string>& options);
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;
};

/// Prints a note that names the options that nothing has asked for, such as misspelt ones; not
/// those that PETSc reads when it ends.
/// @param options  PETSc options as words
/// @note  Collective.
void tell_of_unused_options(const std::vector<std::string>& options);

/// Ends all ranks with this exit code without waiting for them.
[[noreturn]] void abort_all_ranks(int exit_code);

}  // namespace chladni::cli
