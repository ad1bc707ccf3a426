#pragma once

#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// Eigenpairs of the reduced pencil under some support, in the coordinates of ReducedModel.
struct ReducedPairs {
  SmallMatrix X;               ///< [n_m + n_CB x k], X^T M_r X = I; the same on every rank
  std::vector<double> lambda;  ///< [k] rad^2/s^2, positive
};

/// eta^2 = r_s^T K_ss^-1 r_s / lambda for each pair, with r = (K - lambda M) Q_CB x.
/// An eigenvalue of the full pencil under the same support lies within lambda (1 -+ eta); eta^2
/// itself estimates the relative error of lambda, twice that of the frequency. Exact where supports
/// hold masters only: Galerkin's condition leaves no residual in the free ones.
/// @note   Collective; one block solve of k columns with the factor.
std::vector<double> error_estimates(const Factorization& K_ss, const CraigBamptonBasis& Q_CB,
                                    const Blocks& M, const ReducedPairs& pairs);

/// The relative error of a frequency by the eta^2 of its lambda, with the modes from
/// `lambda_left_out` on left out of the basis: eta^2 / 2 is a lower estimate, by the factor
/// 1 - lambda / lambda_left_out at most, by which it is divided; by no less than a fiftieth.
double frequency_error(double eta2, double lambda, double lambda_left_out);

}  // namespace chladni::reduce
