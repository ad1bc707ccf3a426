#include "cli/petsc_session.hpp"

#include <mpi.h>
#include <slepcsys.h>

#include <cstdlib>

#include "common/all_ranks.hpp"
#include "common/petsc.hpp"
#include "linear/blas_kernels.hpp"

namespace chladni::cli {

namespace {

/// Open MPI starts a daemon for a process that no mpirun started, and leaves it behind when that
/// process is killed. One process needs none.
void start_no_daemon()
{
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
}

}  // namespace

PetscSession::PetscSession(const std::vector<std::string>& options)
{
  start_no_daemon();
  std::vector<std::string> words = options;
  // A folder must not choose solvers, or load libraries, because somebody works in it.
  words.insert(words.begin(), {"chladni", "-skip_petscrc"});
  words.emplace_back("-no_signal_handler");  // a crash is a crash, not a page of advice
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  int argc = static_cast<int>(words.size());
  char** argv = pointers.data();
  petsc::check(SlepcInitialize(&argc, &argv, nullptr, nullptr));
  petsc::check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));
  linear::share_processors();
}

PetscSession::~PetscSession()
{
  SlepcFinalize();
}

void abort_all_ranks(int exit_code)
{
  MPI_Abort(PETSC_COMM_WORLD, exit_code);
  std::abort();
}

}  // namespace chladni::cli
