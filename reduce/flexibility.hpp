#pragma once

#include <vector>

#include "linear/lanczos/parted_lanczos.hpp"
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
  Flexibility(const Flexibility&) = delete;
  Flexibility& operator=(const Flexibility&) = delete;

  /// U = A F in all DOFs; A R = 0. This object must outlive the function, as it must those of the
  /// parts.
  linear::BlockSolve solver() const;
  /// The same for the rows of each part into which K and M fall, such as bending and motion in the
  /// plane; empty if all rows are one part, or if the factor of K_ss does not solve for parts.
  std::vector<linear::DecoupledPart> parts() const;
  /// [n x r] rigid motions in all DOFs, R^T M R = I.
  Mat R() const { return R_; }
  /// Number of elastic modes.
  PetscInt n_elastic() const { return n_elastic_; }

 private:
  const WholeSystem& body_;
  Mat Psi_;
  std::vector<int> held_;
  petsc::Matrix R_, MR_;
  Eigen::MatrixXd K_G_inverse_;
  PetscInt n_elastic_ = 0;
};

}  // namespace chladni::reduce
