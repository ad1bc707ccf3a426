#pragma once

#include <Eigen/Core>
#include <vector>

#include "reduce/residual_forms.hpp"

namespace chladni::reduce {

/// Frequencies from .. to, rad/s, with every loss factor of the whole body up to the largest one:
/// K (1 + i eta), 0 <= eta <= loss_factor.
struct DampedBand {
  double from, to;
  double loss_factor;
};

/// Loads on masters of a model that has all modes of the FE model below lambda_left_out and all
/// static shapes of the loaded masters.
struct LoadedModel {
  const ResidualForms& forms;
  const ReducedModel& model;
  const std::vector<int>& still;  ///< masters that are held or that no load moves, ascending
  double lambda_left_out;         ///< rad^2/s^2
  double lambda_of_range;         ///< rad^2/s^2; > 0, the end of the range squared
};

/// The forces that a model does not balance in its responses to harmonic loads, in closed form over
/// the whole range, by the Ritz values of the model beyond lambda_left_out. It needs no
/// communication.
class UnbalancedForces {
 public:
  /// @param F  [masters x l] loads
  UnbalancedForces(const LoadedModel& of, const Eigen::MatrixXd& F);

  /// Upper bounds of the lengths of the columns of E, the error of the responses
  /// u = F^T (K (1 + i eta) - Omega^2 M)^-1 F, for all frequencies and loss factors of a band below
  /// lambda_left_out.
  /// @return [l]; infinity within 1e-4 of lambda_left_out
  Eigen::VectorXd error_bounds(const DampedBand& band) const;

 private:
  struct Region;
  struct Disc;
  Eigen::VectorXd bounds_in(const Region& region, int depth) const;
  Eigen::VectorXd bounds_in(const Disc& disc) const;
  Eigen::MatrixXd amplitudes(const Eigen::VectorXcd& factors) const;

  double lambda_left_out_;
  Eigen::VectorXd theta_;    ///< [p] inverse Ritz values, s^2/rad^2
  Eigen::MatrixXd Y_;        ///< [r x p] Y^T Y are the inner products of their residuals
  Eigen::VectorXd lengths_;  ///< [p] of the columns of Y
  Eigen::MatrixXd gamma_;    ///< [p x l]
};

}  // namespace chladni::reduce
