#pragma once

#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// Eigenpairs of the reduced pencil under some support, in the coordinates of ReducedModel.
struct ReducedPairs {
  Eigen::MatrixXd X;           ///< [n_m + n_CB x k], X^T M_r X = I; the same on every rank
  std::vector<double> lambda;  ///< [k] rad^2/s^2, positive
};

/// What error estimates need of a reduction.
struct Condensation {
  const linear::Factorization& K_ss;
  const CraigBamptonBasis& Q_CB;
  const Blocks& K;
  const Blocks& M;
};

/// How far lambda of reduced pairs may be from an eigenvalue of the FE model, relatively.
struct ErrorEstimates {
  /// eta^2 = r_s^T K_ss^-1 r_s / lambda with r = (K - lambda M) Q_CB x: what the basis lacks.
  std::vector<double> eta2;
  /// What rounding does to lambda, relative: 4 eps sum_j (K_jj / lambda + M_jj) u_j^2, u = Q_CB x,
  /// u^T M u = 1, for the entries of K and M, since |u|^T |K| |u| is about twice the sum of K_jj
  /// u_j^2, of first order; and how far lambda is from the Rayleigh quotient of u in the FE model,
  /// which shows what the eigen-solvers left.
  std::vector<double> rounding;
  /// [k x k] r_i^T K_ss^-1 r_j / sqrt(lambda_i lambda_j), with eta^2 on its diagonal; empty but for
  /// Purpose::bounds.
  Eigen::MatrixXd inner_products = {};
};

/// What errors are computed for.
enum class Purpose { estimates, bounds };

/// The error estimates of each pair. An eigenvalue of the full pencil under the same support has an
/// inverse within (1 -+ eta) / lambda; eta^2 itself estimates the relative error of lambda, twice
/// that of the frequency. Exact where supports hold masters only: Galerkin's condition leaves no
/// residual in the free ones.
/// @param purpose  bounds need the inner products, and K_ss^-1 r of all pairs in memory at a time
/// @note   Collective; one block solve of k columns with the factor.
ErrorEstimates error_estimates(const Condensation& of, const ReducedPairs& pairs,
                               Purpose purpose = Purpose::estimates);

/// The relative error of a frequency by the eta^2 of its lambda, with the modes from
/// `lambda_left_out` on left out of the basis: eta^2 / 2 is a lower estimate, by the factor
/// 1 - lambda / lambda_left_out at most, by which it is divided; by no less than a fiftieth.
double frequency_error(double eta2, double lambda, double lambda_left_out);

/// The estimated relative error of each frequency against the FE frequency of the same place in the
/// order: `frequency_error` of all, which may let one pass another.
/// @param lambda           [k] ascending, rad^2/s^2
/// @param eta2             [k]
/// @param lambda_left_out  infinity where it is not known
std::vector<double> frequency_errors_by_place(const std::vector<double>& lambda,
                                              const std::vector<double>& eta2,
                                              double lambda_left_out);

}  // namespace chladni::reduce
