#pragma once

#include <functional>
#include <vector>

/// The processes that mpirun started, for the time while PETSc runs.
namespace chladni::cases {

/// Rank of this process, and number of all processes.
int rank();
int n_ranks();

/// The sum, and the maximum, of x over all ranks.
/// @note   Collective.
double sum_over_ranks(double x);
double largest_of_ranks(double x);

/// The numbers of all ranks in one list, in the order of the ranks.
/// @note   Collective.
std::vector<double> joined(const std::vector<double>& own);

/// Calls `work` on the first rank, while the others wait.
/// @note   Collective.
/// @throws chladni::Error on all ranks, with the text of what `work` threw.
void on_first_rank(const std::function<void()>& work);

}  // namespace chladni::cases
