// The vectors that a BlockIteration gives out.
#include <algorithm>
#include <cmath>

#include "common/eigen_every.hpp"
#include "linear/kernels/columns_with_mass.hpp"
#include "linear/lanczos/block_iteration.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

MatrixXd BlockIteration::ritz_coefficients(PetscInt first, PetscInt last) const
{
  return ritz_.vectors(every, std::span(order_).subspan(first, last - first));
}

petsc::Matrix BlockIteration::ritz_vectors(PetscInt n) const
{
  return basis_.combine(ritz_coefficients(0, n));
}

MatrixXd BlockIteration::purified_coefficients(PetscInt first, PetscInt last) const
{
  MatrixXd S = MatrixXd::Zero(basis_.n_columns(), last - first);
  for (PetscInt k = 0; k < S.cols(); ++k) {
    const auto ritz = static_cast<PetscInt>(first + k);
    S.col(k).head(n_old_) = ritz_.vectors.col(order_[ritz]);
    for (PetscInt a = 0; a < basis_.n_columns() - n_old_; ++a) {
      for (PetscInt c = 0; c < R_.cols(); ++c) {
        S(n_old_ + a, k) +=
            R_(a, c) * ritz_.vectors(n_old_ - R_.cols() + c, order_[ritz]) / theta(ritz);
      }
    }
    double norm = 0.0;  // in the M-orthonormal basis
    for (PetscInt i = 0; i < S.rows(); ++i) norm += S(i, k) * S(i, k);
    S.col(k) /= std::sqrt(norm);
  }
  return S;
}

petsc::Matrix BlockIteration::purified_vectors(PetscInt first, PetscInt last,
                                               const BlockOperator& op) const
{
  const bool is_whole = std::ranges::all_of(left_out_, [](double length) { return length == 0.0; });
  if (is_whole) return basis_.combine(purified_coefficients(first, last));
  return applied_vectors(first, last, op);
}

/// By one true application of the operator. It amplifies what round-off a vector has of those with
/// larger |theta|, which is taken out again.
petsc::Matrix BlockIteration::applied_vectors(PetscInt first, PetscInt last,
                                              const BlockOperator& op) const
{
  constexpr PetscInt width = 32;
  const petsc::Matrix X = basis_.combine(ritz_coefficients(0, last));
  petsc::Matrix purified = basis_.new_vectors(last - first);
  for (PetscInt at = first; at < last; at += width) {
    const PetscInt end = std::min(at + width, last);
    const ColumnRange target(purified, at - first, end - first);
    {
      const ColumnRange some(X, at, end);
      op(some, basis_.times_mass(some), target);
    }
    MatrixXd C = inner_product(X, basis_.times_mass(target));
    for (PetscInt k = at; k < end; ++k) {
      for (PetscInt i = 0; i < last; ++i)
        if (std::abs(theta(i)) <= std::abs(theta(k))) C(i, k - at) = 0.0;
    }
    add_product(-1.0, X, C, target);
    normalise_columns(target, basis_.times_mass(target));
  }
  return purified;
}

}  // namespace chladni::linear
