#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/error.hpp"
#include "linear/cholesky/sylvester.hpp"
#include "linear/kernels/dense_matrices.hpp"

namespace chladni::reduce {

/// Eigenvalues below sigma: of the full pencil by Sylvester's law, and of the reduced one.
struct EigenvalueCount {
  double sigma = 0.0;  ///< rad^2/s^2; 0 where nothing was counted
  int expected = 0;
  int found = 0;

  int missing() const { return expected - found; }
};

/// The eigenvalues of the reduced pencil under some support.
struct ReducedSpectrum {
  std::vector<double> lambda;  ///< all positive ones, ascending; rad^2/s^2
  Eigen::MatrixXd residuals;   ///< [k x k] of the first k, `ErrorEstimates::inner_products`
  int n_zero;                  ///< zero eigenvalues before them
  MPI_Comm comm;               ///< ranks that count together; the first one decides
  /// Where the range ends that is counted, if the residuals reach so far; else above the last of
  /// them.
  std::optional<double> ends_at = {};
};

/// What a count of eigenvalues certifies.
struct Completeness {
  EigenvalueCount range;       ///< up to Ritz value k
  EigenvalueCount complete;    ///< the largest range looked at in which none is missing
  std::vector<double> bounds;  ///< of the relative errors of the Ritz values below complete.sigma
};

/// Counts the fixed-interface modes up to the last one that is there; modes that close to it are
/// never cut off.
/// @param omega              [k >= 1] ascending, rad/s
/// @param eigenvalues_below  of K_ss, M_ss; as of `count_modes`
/// @throws chladni::Error as `count_modes`
EigenvalueCount count_fixed_interface(const std::vector<double>& omega,
                                      const std::function<int(double sigma)>& eigenvalues_below);

/// Counts up to the last Ritz value with an error estimate and, while one is missing, in gaps at
/// about half and a quarter of it.
/// @param eigenvalues_below  of the full pencil under the same support; one factorisation each.
///                           Where it throws SingularShift another shift close by is tried.
/// @throws chladni::Error when a count is lower than what the reduced model has, which only a wrong
///         count can be.
Completeness count_modes(ReducedSpectrum ritz,
                         const std::function<int(double sigma)>& eigenvalues_below);

/// Upper bounds of the relative errors lambda_i~ / lambda_i - 1 of Ritz values, from the inner
/// products H of their residuals and the certainty that the full pencil has exactly as many
/// eigenvalues below `sigma` as are given: with theta = 1 / lambda~ and alpha = 1 / sigma the
/// eigenvalues of ((Theta - alpha)^2 + Theta H Theta, Theta - alpha) are no less than 1 / lambda -
/// alpha (Lehmann). One value alone has eta^2 / (1 - lambda~ / sigma) (Temple). What rounding does
/// to the Ritz values comes on top.
/// @param lambda     [k] ascending, positive, all below sigma; rad^2/s^2
/// @param residuals  [at least k x k] H, `ErrorEstimates::inner_products`
/// @return [k]
/// Source: Lehmann, Z. angew. Math. Mech. 29 (1949) 341; Temple, Proc. R. Soc. Lond. A 119 (1928)
/// 276.
std::vector<double> error_bounds(const std::vector<double>& lambda,
                                 const Eigen::MatrixXd& residuals, double sigma);

}  // namespace chladni::reduce
