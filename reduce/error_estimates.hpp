#pragma once

#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// Eigenpairs of the reduced pencil under some support, in the coordinates of ReducedModel.
struct ReducedPairs {
  Eigen::MatrixXd X;           ///< [n_m + n_CB x k], X^T M_r X = I; the same on every rank
  std::vector<double> lambda;  ///< [k] rad^2/s^2, positive
};

/// The parts of a reduction that error estimates need.
struct Condensation {
  const linear::Factorization& K_ss;
  const CraigBamptonBasis& Q_CB;
  const Blocks& K;
  const Blocks& M;
};

/// Relative distances of each lambda of reduced pairs from an eigenvalue of the FE model.
struct ErrorEstimates {
  /// [k] eta^2 = r_s^T K_ss^-1 r_s / lambda with r = (K - lambda M) Q_CB x: the error by what the
  /// basis lacks.
  std::vector<double> eta2;
  /// [k] The error of lambda by rounding, relative, a sum of two terms. The first is that of the
  /// entries of K and M, 4 eps sum_j (K_jj / lambda + M_jj) u_j^2 with u = Q_CB x and u^T M u = 1,
  /// to first order, since |u|^T |K| |u| is about twice the sum of K_jj u_j^2. The second is the
  /// distance of lambda from the Rayleigh quotient of u in the FE model, which shows the error that
  /// the eigen-solvers left.
  std::vector<double> rounding;
  /// [k x k] r_i^T K_ss^-1 r_j / sqrt(lambda_i lambda_j), with eta^2 on its diagonal; set for
  /// Purpose::bounds only.
  Eigen::MatrixXd inner_products = {};
};

/// What errors are computed for: estimates alone, or bounds too.
enum class Purpose { estimates, bounds };

/// Error estimates of each pair. The full pencil under the same support has an eigenvalue whose
/// inverse lies within (1 -+ eta) / lambda; eta^2 itself estimates the relative error of lambda,
/// which is twice that of the frequency. The supports must hold masters only: then Galerkin's
/// condition leaves no residual at the free masters.
/// @param purpose  bounds need the inner products, for which the half solutions of all pairs stay
///                 in memory
/// @note   Collective; one block solve of k columns with the factor.
ErrorEstimates error_estimates(const Condensation& of, const ReducedPairs& pairs,
                               Purpose purpose = Purpose::estimates);

/// Estimated relative error of a frequency from the eta^2 of its lambda: eta^2 / 2, divided by 1 -
/// lambda / lambda_left_out but by no less than 0.02. eta^2 / 2 alone is too low by at most that
/// factor when the modes from `lambda_left_out` on are not in the basis.
double frequency_error(double eta2, double lambda, double lambda_left_out);

/// Estimated relative error of each frequency against the FE frequency at the same place in the
/// ascending order. The FE frequencies come from `frequency_error` of each mode and are sorted,
/// since corrected frequencies may change their order.
/// @param lambda           [k] ascending, rad^2/s^2
/// @param eta2             [k]
/// @param lambda_left_out  rad^2/s^2; infinity where it is not known
/// @return [k]
std::vector<double> frequency_errors_by_place(const std::vector<double>& lambda,
                                              const std::vector<double>& eta2,
                                              double lambda_left_out);

}  // namespace chladni::reduce
