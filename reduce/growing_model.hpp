#pragma once

#include <vector>

#include "reduce/craig_bampton.hpp"
#include "reduce/error_estimates.hpp"

namespace chladni::reduce {

/// Craig-Bampton models with the first n of ever more fixed-interface modes, and their error
/// estimates without any further work on the FE model. With B = M_ss Psi + M_sm, Galerkin's rows of
/// the modes make of the residual r_s = -lambda (B - M_ss Phi P) x_m, and so
///   eta^2 = r_s^T K_ss^-1 r_s / lambda = lambda x_m^T G_n x_m,
///   G_n = B^T K_ss^-1 B - sum_(k < n) P_k^T P_k / omega_k^2.
/// The sum over the modes that come first is taken out of B before anything cancels.
class GrowingModel {
 public:
  struct System {
    const linear::Factorization& K_ss;
    Mat Psi;
    const Blocks& K;
    const Blocks& M;
  };

  /// The Guyan model. What `system` refers to must outlive this.
  /// @note   Collective, as all members that take a Mat.
  explicit GrowingModel(const System& system);

  /// More modes. The first time this solves n_m columns with the factor.
  /// @param omega  of the columns of Phi, rad/s
  void append(Mat Phi, const std::vector<double>& omega);
  PetscInt n_modes() const { return static_cast<PetscInt>(omega_.size()); }
  const std::vector<double>& omega() const { return omega_; }

  /// The reduced model with the first n modes.
  ReducedModel model(PetscInt n) const;
  /// The same with so much mass added at the masters that at least as many of its eigenvalues lie
  /// below sigma as the FE model has there, under any support of the masters. The modes left out,
  /// from lambda_left_out > sigma on, add sigma^2 sum_k P_k^T P_k / (omega_k^2 - sigma) to the
  /// masters' part of K - sigma M, at most sigma^2 G_n / (1 - sigma / lambda_left_out).
  ReducedModel heavier_model(PetscInt n, double sigma, double lambda_left_out) const;
  /// eta^2 of pairs of that model, as `reduce::error_estimates` to first order in what the
  /// eigen-solver left; what is below 1e-12 or so is round-off.
  std::vector<double> error_estimates(const ReducedPairs& pairs, PetscInt n) const;

 private:
  void start_errors(Mat Phi);
  Eigen::MatrixXd G(PetscInt n) const;

  System system_;
  GuyanStiffness K_G_;
  Eigen::MatrixXd M_G_;
  Eigen::MatrixXd P_;     ///< [n_modes x n_m]
  Eigen::MatrixXd G_;     ///< G_n of the modes that came first
  PetscInt n_first_ = 0;  ///< how many these are
  std::vector<double> omega_;
};

}  // namespace chladni::reduce
