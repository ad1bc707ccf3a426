#include "cli/petsc_session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mpi.h>
#include <slepcsys.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "common/all_ranks.hpp"
#include "common/petsc.hpp"
#include "linear/blas_kernels.hpp"
#include "report/progress.hpp"

namespace chladni::cli {

namespace {

bool is_started_by_mpirun()
{
  constexpr std::array<const char*, 4> ranks{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK",
                                             "SLURM_PROCID"};
  return std::ranges::any_of(ranks, [](const char* rank) { return std::getenv(rank) != nullptr; });
}

/// Open MPI starts a daemon for a process that no mpirun started, and leaves it behind when that
/// process is killed. One process needs none. It makes a folder for those of a user, too, which one
/// process may remove while another begins, and which nobody needs who shares no memory. And it
/// loads what it knows of networks, of which libpsm2 sleeps for 0.2 s to learn how fast a clock is.
void start_alone()
{
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  if (is_started_by_mpirun()) return;
  setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  setenv("OMPI_MCA_pml", "ob1", 0);
}

/// How options begin that PETSc reads when it ends.
constexpr std::array<std::string_view, 9> read_at_the_end{"options_",        "log",      "malloc",
                                                          "memory_",         "objects_", "mpidump",
                                                          "get_total_flops", "viewer_",  "x_"};

/// Those of the words that are names of options and that nothing has asked for.
std::vector<std::string> unused_options(const std::vector<std::string>& options)
{
  PetscInt n = 0;
  char **names = nullptr, **values = nullptr;
  petsc::check(PetscOptionsLeftGet(nullptr, &n, &names, &values));
  std::vector<std::string> unused;
  for (PetscInt i = 0; i < n; ++i) {
    const std::string_view name = names[i];
    const bool comes_late = std::ranges::any_of(
        read_at_the_end, [&](std::string_view beginning) { return name.starts_with(beginning); });
    std::string word = fmt::format("-{}", name);
    if (!comes_late && std::ranges::find(options, word) != options.end())
      unused.push_back(std::move(word));
  }
  petsc::check(PetscOptionsLeftRestore(nullptr, &n, &names, &values));
  return unused;
}

}  // namespace

PetscSession::PetscSession(const std::vector<std::string>& options)
{
  start_alone();
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

void tell_of_unused_options(const std::vector<std::string>& options)
{
  const std::vector<std::string> unused = unused_options(options);
  if (unused.empty() || petsc::rank(PETSC_COMM_WORLD) != 0) return;
  report::tell_note(
      fmt::format("nothing here used the PETSc option{} {}; check the spelling (-help lists those "
                  "that there are)",
                  unused.size() == 1 ? "" : "s", fmt::join(unused, ", ")));
}

void abort_all_ranks(int exit_code)
{
  MPI_Abort(PETSC_COMM_WORLD, exit_code);
  std::abort();
}

}  // namespace chladni::cli
