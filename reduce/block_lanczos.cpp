#include "reduce/block_lanczos.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "reduce/block_iteration.hpp"

namespace chladni::reduce {

namespace {

PetscInt capacity(Mat M, const BlockLanczosOptions& options)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(M, &n, nullptr));
  const PetscInt b = options.block_size;
  const PetscInt wanted = options.max_subspace > 0
                              ? std::max(options.max_subspace, options.n_pairs + 4 * b)
                              : 2 * options.n_pairs + 16 * b;
  return std::min(wanted, n) + b;
}

bool converged(BlockIteration& iteration, const BlockLanczosOptions& options)
{
  if (iteration.n_vectors() < options.n_pairs && !iteration.is_exhausted()) return false;
  iteration.order_ritz_values(std::greater<>());
  const PetscInt n = std::min(options.n_pairs, iteration.n_vectors());
  for (PetscInt i = n - 1; i >= 0; --i) {  // the highest converge last
    if (iteration.residual(i) > options.tolerance * std::abs(iteration.theta(i))) return false;
  }
  return true;
}

/// Keeps the wanted Ritz vectors and half of the others.
void restart(BlockIteration& iteration, const BlockLanczosOptions& options)
{
  const PetscInt n = iteration.n_vectors();
  iteration.order_ritz_values(std::greater<>());
  iteration.restart(std::min(n - 1, options.n_pairs + (n - options.n_pairs) / 2));
}

EigenPairs extract(const BlockIteration& iteration, PetscInt n_pairs, PetscInt n_solves)
{
  const PetscInt n = std::min(n_pairs, iteration.n_vectors());
  EigenPairs pairs{
      .lambda = {}, .residual = {}, .X = iteration.purified_vectors(n), .n_solves = n_solves};
  for (PetscInt i = 0; i < n; ++i) {
    pairs.lambda.push_back(1.0 / iteration.theta(i));
    pairs.residual.push_back(iteration.residual(i) / std::abs(iteration.theta(i)));
  }
  return pairs;
}

}  // namespace

EigenPairs block_lanczos(Mat factor, Mat M, const BlockLanczosOptions& options)
{
  PetscInt n_solves = 0;
  const BlockOperator op = [&](Mat, Mat MQ, Mat Y) {
    PetscInt n_columns = 0;
    petsc::check(MatGetSize(MQ, nullptr, &n_columns));
    petsc::check(MatMatSolve(factor, MQ, Y));
    n_solves += n_columns;
  };
  BlockIteration iteration(M, options.block_size, capacity(M, options));
  iteration.start(op);
  for (PetscInt i = 0; i < options.max_steps; ++i) {
    iteration.step(op);
    if (converged(iteration, options)) return extract(iteration, options.n_pairs, n_solves);
    if (iteration.is_full()) restart(iteration, options);
  }
  throw Error(
      fmt::format("block_lanczos: {} pairs did not converge to {:.1e} in {} block solves; "
                  "ask for fewer or raise the tolerance",
                  options.n_pairs, options.tolerance, options.max_steps));
}

}  // namespace chladni::reduce
