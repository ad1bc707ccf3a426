#pragma once

#include <functional>
#include <vector>

/// The processes that mpirun started, while PETSc runs.
namespace chladni::cases {

/// Of this process among those that mpirun started.
int rank();
int n_ranks();

/// Over all ranks. @note Collective.
double sum_over_ranks(double x);
double largest_of_ranks(double x);

/// All ranks' numbers in one list, by rank. @note Collective.
std::vector<double> joined(const std::vector<double>& own);

/// Performs `work` on the first rank, while the others wait for it.
/// @throws chladni::Error on all ranks, with the text of what `work` threw on the first.
/// @note   Collective.
void on_first_rank(const std::function<void()>& work);

}  // namespace chladni::cases
