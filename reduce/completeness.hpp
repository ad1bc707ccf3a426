#pragma once

#include <functional>
#include <vector>

namespace chladni::reduce {

/// Eigenvalues below sigma: of the full pencil by Sylvester's law, and of the reduced one.
struct EigenvalueCount {
  double sigma = 0.0;  ///< rad^2/s^2; 0 where nothing was counted
  int expected = 0;
  int found = 0;

  int missing() const { return expected - found; }
};

/// Ritz values of the reduced pencil under some support.
struct RitzValues {
  std::vector<double> lambda;  ///< all positive ones, ascending; rad^2/s^2
  std::vector<double> eta2;    ///< [k] of the first k, as of `error_estimates`
  int n_zero;                  ///< zero eigenvalues before them
};

/// What a count of eigenvalues certifies.
struct Completeness {
  EigenvalueCount range;       ///< up to Ritz value k
  EigenvalueCount complete;    ///< the largest range looked at in which none is missing
  std::vector<double> bounds;  ///< of the relative errors of the Ritz values below complete.sigma
};

/// Counts up to the last Ritz value with an error estimate and, while one is missing, in gaps at
/// about half and a quarter of it.
/// @param eigenvalues_below  of the full pencil under the same support; one factorisation each
Completeness count_modes(const RitzValues& ritz,
                         const std::function<int(double sigma)>& eigenvalues_below);

/// Upper bounds of the relative errors lambda_i~ / lambda_i - 1 of Ritz values, from eta^2 and the
/// certainty that the full pencil has exactly as many eigenvalues below `sigma` as are given.
/// Alone: eta^2 / gap, gap = 1 - lambda_i~ / lambda_next with a lower bound of the next eigenvalue
/// (Kato and Temple), or eta where that is less. In a cluster, where the first-order intervals of
/// several Ritz values overlap: the same of first and second order for their residuals together.
/// @param lambda  [k] ascending, positive, all below sigma; rad^2/s^2
/// @param eta2    [k]
/// @return [k]
/// Source: Kato, J. Phys. Soc. Japan 4 (1949) 334; Temple, Proc. R. Soc. Lond. A 119 (1928) 276;
/// Li and Li, Linear Algebra Appl. 395 (2005) 183.
std::vector<double> error_bounds(const std::vector<double>& lambda, const std::vector<double>& eta2,
                                 double sigma);

}  // namespace chladni::reduce
