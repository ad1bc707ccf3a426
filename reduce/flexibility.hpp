#pragma once

#include <memory>
#include <vector>

#include "reduce/mixed_interface.hpp"

namespace chladni::reduce {

/// The flexibility of a body with some masters held, A = P K^+ P^T with P = I - R R^T M, where R
/// are the rigid motions that the supports leave. A f is the displacement, free of rigid motion and
/// zero at the held masters, under the forces f without the part that accelerates the body as a
/// rigid one. The only large factor is that of K_ss; beside it the small dense K_G is inverted
/// without the motions R and the held rows. A factor of K between the free DOFs would spare the
/// products with Psi; it was slower, since masters on a ring cut the mesh and with it K_ss into
/// pieces.
class Flexibility {
 public:
  /// @param body, Psi  must outlive this object
  /// @param held       rows of K_G, ascending
  /// @note   Collective, as are all members.
  /// @throws chladni::Error when a rigid motion has no mass.
  Flexibility(const WholeSystem& body, Mat Psi, const GuyanStiffness& K_G,
              const std::vector<int>& held);
  ~Flexibility();
  Flexibility(const Flexibility&) = delete;
  Flexibility& operator=(const Flexibility&) = delete;

  /// A matrix that applies A through MatMatSolve, as a factor does; A R = 0.
  Mat factor() const { return factor_; }
  /// [n x r] rigid motions in all DOFs, R^T M R = I.
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
