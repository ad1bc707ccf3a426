#include "linear/cholesky/inverse_form.hpp"

#include <utility>

#include "linear/cholesky/local_array.hpp"
#include "linear/cholesky/supernodal_of.hpp"
#include "linear/kernels/dense_matrices.hpp"

namespace chladni::linear {

bool halves(Mat factor)
{
  const SupernodalFactor* ours = supernodal_of(factor);
  return ours != nullptr && ours->n_negative_pivots() == 0;
}

InverseForm inverse_form(Mat factor, petsc::Matrix B)
{
  if (halves(factor)) {
    supernodal_of(factor)->solve_half(LocalArray(B).columns());
    return {.left = std::move(B), .forces = {}};
  }
  petsc::Matrix solutions = uninitialized_dense(B, LocalRows(B).n_cols());
  petsc::check(MatMatSolve(factor, B, solutions));
  return {.left = std::move(solutions), .forces = std::move(B)};
}

}  // namespace chladni::linear
