#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "reduce/craig_bampton.hpp"
#include "reduce/error_estimates.hpp"
#include "reduce/fixed_interface_modes.hpp"

namespace chladni::reduce {

/// Craig-Bampton models with the first n of a growing number of fixed-interface modes, and their
/// error estimates without further work on the FE model. With B = M_ss Psi + M_sm, Galerkin's
/// condition for the modes makes the residual r_s = -lambda (B - M_ss Phi P) x_m, and so
///   eta^2 = r_s^T K_ss^-1 r_s / lambda = lambda x_m^T G_n x_m,
///   G_n = B^T K_ss^-1 B - sum_(k < n) P_k^T P_k / omega_k^2.
/// The modes of the first `append` are removed from B itself, to avoid cancellation in this
/// difference.
class GrowingModel {
 public:
  struct System {
    const linear::Factorization& K_ss;
    Mat Psi;
    const Blocks& K;
    const Blocks& M;
  };

  /// Starts with the Guyan model. What `system` refers to must outlive this object.
  /// @note   Collective, as are all members that take a Mat.
  explicit GrowingModel(const System& system);

  /// Adds modes. The first call solves for n_m columns with the factor.
  /// @param omega  rad/s, one for each column of Phi
  void append(Mat Phi, const std::vector<double>& omega);
  PetscInt n_modes() const { return static_cast<PetscInt>(omega_.size()); }
  const std::vector<double>& omega() const { return omega_; }

  /// The reduced model with the first n modes.
  ReducedModel model(PetscInt n) const;
  /// The model of the first n modes with mass added at the masters, so that it has at least as many
  /// eigenvalues below sigma as the FE model, under any support of the masters. The modes left out,
  /// whose eigenvalues begin at lambda_left_out > sigma, add sigma^2 sum_k P_k^T P_k / (omega_k^2 -
  /// sigma) to the masters' part of K - sigma M, which is at most sigma^2 G_n / (1 - sigma /
  /// lambda_left_out).
  /// @param sigma, lambda_left_out  rad^2/s^2
  ReducedModel heavier_model(PetscInt n, double sigma, double lambda_left_out) const;
  /// eta^2 of pairs of `model(n)`, equal to `reduce::error_estimates` to first order in the error
  /// of the eigen-solver. Values below about 1e-12 are round-off.
  std::vector<double> error_estimates(const ReducedPairs& pairs, PetscInt n) const;

 private:
  void start_errors(Mat Phi);
  Eigen::MatrixXd G(PetscInt n) const;

  System system_;
  GuyanStiffness K_G_;
  Eigen::MatrixXd M_G_;
  Eigen::MatrixXd P_;     ///< [n_modes x n_m]
  Eigen::MatrixXd G_;     ///< G_n of the modes of the first `append`
  PetscInt n_first_ = 0;  ///< the number of these modes
  std::vector<double> omega_;
};

/// The tolerance that the modes must keep and its range.
struct ToleranceGoal {
  double tolerance;  ///< for `frequency_error`
  /// End of the range of FE frequencies. Reduced pairs somewhat above it count too, since reduced
  /// frequencies are too high.
  double up_to_Hz;
};

/// Finds about as few fixed-interface modes as keep the error estimates of a range of the spectrum
/// below a tolerance. All fixed-interface modes of the range are always taken: under supports that
/// hold all masters each mode of the basis is exact, and a missing one has no estimate. Also, the
/// reduced model must have a frequency for each one of the FE model in the range;
/// `GrowingModel::heavier_model` shows that. Call `find_modes` and `is_enough` in turn until the
/// latter returns true. Neither the modes nor the data of their errors are computed twice.
class ToleranceSearch {
 public:
  /// Returns the pairs of a reduced model whose errors count, the same on every rank.
  using PairsOf = std::function<ReducedPairs(const ReducedModel&)>;

  /// What `system` refers to must outlive this object.
  ToleranceSearch(const GrowingModel::System& system, const ToleranceGoal& goal,
                  PairsOf pairs_in_range, MemoryCheck require_memory = {});

  /// Finds the number of modes that `is_enough` predicted.
  /// @note   Collective.
  /// @throws chladni::Error when there are no more modes, the eigen-solver does not converge, or
  ///         the memory does not suffice.
  void find_modes();
  /// True when the modes keep the tolerance; the smallest number that does is then found by
  /// bisection.
  /// @note   Collective.
  bool is_enough();
  /// The modes that are enough.
  /// @note   Collective.
  FixedInterfaceModes modes() const { return search_.leading(n_enough_); }

 private:
  struct Tried {
    PetscInt n;
    double error;
  };

  double error(PetscInt n) const;
  bool may_lack_a_frequency(PetscInt n) const;
  double lambda_left_out(PetscInt n) const;
  PetscInt n_in_range() const;
  bool covers_range() const;
  PetscInt more_of_range() const;
  PetscInt least() const;
  PetscInt bisected(PetscInt too_few, PetscInt enough,
                    const std::function<bool(PetscInt)>& is_enough) const;
  PetscInt prediction() const;
  PetscInt n_complete() const;

  GrowingModel::System system_;
  ToleranceGoal goal_;
  PairsOf pairs_in_range_;
  ModeSearch search_;
  std::optional<GrowingModel> model_;
  PetscInt n_asked_;
  std::vector<Tried> too_few_;
  PetscInt n_enough_ = 0;
};

}  // namespace chladni::reduce
