#pragma once

#include <memory>

#include "reduce/free_interface.hpp"

namespace chladni::reduce {

/// The flexibility of a free body, A = P K^+ P^T with P = I - R R^T M and R its rigid motions:
/// displacements A f without rigid motion, under the forces f without what accelerates the body as
/// a rigid one. It needs no factor but that of K_ss: K_G is small, and its inverse without the
/// motions R is one of a small dense matrix.
class FreeFlexibility {
 public:
  /// @param body, Psi  must outlive this.
  /// @note   Collective, as all of this class.
  /// @throws chladni::Error when a rigid motion has no mass.
  FreeFlexibility(const WholeSystem& body, Mat Psi, const GuyanStiffness& K_G);
  ~FreeFlexibility();
  FreeFlexibility(const FreeFlexibility&) = delete;
  FreeFlexibility& operator=(const FreeFlexibility&) = delete;

  /// The factor of a matrix with the inverse A, for MatMatSolve; A R = 0.
  Mat factor() const { return factor_; }
  /// [n x r] of all DOFs, R^T M R = I.
  Mat R() const { return R_; }

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  petsc::Matrix R_, factor_;
};

}  // namespace chladni::reduce
