#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/error.hpp"
#include "linear/cholesky/sylvester.hpp"
#include "linear/kernels/dense_matrices.hpp"

namespace chladni::reduce {

/// Shifts of counts stand at least this far from all eigenvalues that were found, relatively.
inline constexpr double gap_of_counts = 3e-5;

/// The number of eigenvalues below sigma: of the full pencil (by Sylvester's law), and of the
/// reduced pencil.
struct EigenvalueCount {
  double sigma = 0.0;  ///< rad^2/s^2; 0 where nothing was counted
  int expected = 0;    ///< of the full pencil
  int found = 0;       ///< of the reduced pencil

  int missing() const { return expected - found; }
};

/// The eigenvalues of the reduced pencil under some support.
struct ReducedSpectrum {
  std::vector<double> lambda;  ///< all positive ones, ascending; rad^2/s^2
  Eigen::MatrixXd residuals;   ///< [k x k] of the first k, `ErrorEstimates::inner_products`
  int n_zero;                  ///< zero eigenvalues before them
  MPI_Comm comm;               ///< ranks that count together; the first one decides
  /// rad^2/s^2; end of the range to count in, used if the residuals reach as far. Without it the
  /// count ends just above the last Ritz value with a residual.
  std::optional<double> ends_at = {};
};

/// The result of counting eigenvalues.
struct Completeness {
  EigenvalueCount range;     ///< up to the last Ritz value with an error estimate
  EigenvalueCount complete;  ///< the largest counted range in which none is missing
  /// Bounds of the relative errors of the Ritz values below complete.sigma.
  std::vector<double> bounds;
};

/// Counts the fixed-interface modes up to just above the last one of the basis. A search never
/// separates modes that are closer together than this.
/// @param omega              [k >= 1] ascending, rad/s
/// @param eigenvalues_below  number of eigenvalues of (K_ss, M_ss) below sigma; as in `count_modes`
/// @throws chladni::Error as `count_modes`.
EigenvalueCount count_fixed_interface(const std::vector<double>& omega,
                                      const std::function<int(double sigma)>& eigenvalues_below);

/// Counts the eigenvalues up to the last Ritz value with an error estimate, number k. While
/// eigenvalues are missing, it counts again in gaps between values k / 2 and k, then k / 4 and
/// k / 2, and so on.
/// @param eigenvalues_below  number of eigenvalues of the full pencil below sigma under the same
///                           support; each call costs one factorisation. If it throws
///                           SingularShift, a shift close by is tried.
/// @throws chladni::Error when a count is lower than the number of Ritz values, which only a wrong
///         count can be.
Completeness count_modes(ReducedSpectrum ritz,
                         const std::function<int(double sigma)>& eigenvalues_below);

/// Upper bounds of the relative errors lambda_i~ / lambda_i - 1 of Ritz values, from the inner
/// products H of their residuals. They hold if the full pencil has exactly k eigenvalues below
/// `sigma`: with theta = 1 / lambda~ and alpha = 1 / sigma, the eigenvalues of ((Theta - alpha)^2 +
/// Theta H Theta, Theta - alpha) are no less than 1 / lambda - alpha (Lehmann). For k = 1 the bound
/// is eta^2 / (1 - lambda~ / sigma) (Temple). The effect of rounding on the Ritz values is not
/// included.
/// @param lambda     [k] ascending, positive, all below sigma; rad^2/s^2
/// @param residuals  [at least k x k] H, `ErrorEstimates::inner_products`
/// @return [k]
/// Source: Lehmann, Z. angew. Math. Mech. 29 (1949) 341; Temple, Proc. R. Soc. Lond. A 119 (1928)
/// 276.
std::vector<double> error_bounds(const std::vector<double>& lambda,
                                 const Eigen::MatrixXd& residuals, double sigma);

}  // namespace chladni::reduce
