#pragma once

#include <memory>
#include <vector>

#include "reduce/mixed_interface.hpp"

namespace chladni::reduce {

/// The flexibility of a body some of whose masters are held, A = P K^+ P^T with P = I - R R^T M and
/// the rigid motions R that are left to it: displacements A f without rigid motion, under the
/// forces f without what accelerates the body as a rigid one; zero at the held masters. It needs no
/// factor but that of K_ss: K_G is small, and its inverse without the motions R and the held rows
/// is one of a small dense matrix.
class Flexibility {
 public:
  /// @param body, Psi  must outlive this.
  /// @param held  rows of K_G, ascending
  /// @note   Collective, as all of this class.
  /// @throws chladni::Error when a rigid motion has no mass.
  Flexibility(const WholeSystem& body, Mat Psi, const GuyanStiffness& K_G,
              const std::vector<int>& held);
  ~Flexibility();
  Flexibility(const Flexibility&) = delete;
  Flexibility& operator=(const Flexibility&) = delete;

  /// The factor of a matrix with the inverse A, for MatMatSolve; A R = 0.
  Mat factor() const { return factor_; }
  /// [n x r] of all DOFs, R^T M R = I.
  Mat R() const { return R_; }
  /// Number of elastic modes.
  PetscInt n_elastic() const { return n_elastic_; }

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  petsc::Matrix R_, factor_;
  PetscInt n_elastic_ = 0;
};

}  // namespace chladni::reduce
