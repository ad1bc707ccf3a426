#pragma once

#include <Eigen/Core>

#include <complex>
#include <functional>
#include <vector>

#include "squeal/brake/disc.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/stability_results.hpp"
#include "squeal/stability/hill_table.hpp"
#include "squeal/stability/stability_search.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// The search of `options.stability`; if absent, all motions over the speeds of the study.
StabilityCase stability_case(const StudyOptions& options);

/// Refuses a frequency band above the range of a disc's modes with inertia, where the modes do not
/// represent the disc.
/// @throws chladni::Error with the band and the range of the modes.
void require_band_of(const Disc& disc, const StabilityCase& search);

/// Computes the table of a disc that is not axisymmetric.
using TurningTableOf =
    std::function<StabilityTable(const FlexibleDisc& brake, const StabilityCase& search)>;

/// Table of all motions of the sliding brake with a frequency in the band at some value of the
/// parameter. They are followed by their shapes (see mode_samples.hpp) at 128 or more values, with
/// the intervals in which each is unstable (see mode_limits.hpp). Growth within rounding errors of
/// a neutral motion does not count. For a disc that is not axisymmetric the table is computed by
/// Hill's method; see turning_table.hpp.
/// @param by_hill  computes that table; an analysis among others passes the TurningTables of its
///         run
/// @throws chladni::Error for a band that the modes of the body do not reach.
StabilityTable unstable_modes(const Brake& brake, const StabilityCase& search,
                              const TurningTableOf& by_hill = turning_table);

/// The motions of x' = A x at one value of the parameter, one for each mode; see
/// oscillating_eigenvalues.
struct ModeSample {
  double value;             ///< of the parameter
  Eigen::VectorXcd lambda;  ///< [n] 1/s
  Eigen::MatrixXcd X;       ///< [2 n x n] right eigenvectors of norm 1
  Eigen::MatrixXcd Y;       ///< [2 n x n] left eigenvectors of norm 1, y^H A = lambda y^H
  /// [n] growth rate that rounding errors may cause for a neutral motion, 1/s.
  Eigen::VectorXd doubt;

  Eigen::Index size() const { return lambda.size(); }
  double growth(Eigen::Index j) const { return lambda[j].real(); }
  double doubt_of(Eigen::Index j) const { return doubt[j]; }
  bool is_unstable(Eigen::Index j) const { return growth(j) > doubt[j]; }
  StabilityPoint point(Eigen::Index j) const;
};

/// The motions at a value, in the order of `oscillating_eigenvalues`.
/// @throws chladni::Error when the QR algorithm does not converge.
ModeSample mode_sample(const StateMatrixOf& A, double value);

/// Equally spaced samples whose column j is the same motion. Motions are followed by the MAC of
/// left and right eigenvectors, |x_i^H x_j| |y_i^H y_j|, and by the distance of lambda from its
/// extrapolation. If two motions cannot be distinguished between two samples, intermediate values
/// are computed.
/// @param range  with at least one value
std::vector<ModeSample> followed_modes(const StateMatrixOf& A, const SearchRange& range);

/// The sample between two others with the same order of motions, at t = 0 ... 1 from the first to
/// the second.
ModeSample mode_sample_between(const StateMatrixOf& A, const ModeSample& low,
                               const ModeSample& high, double t);

/// Work per period of the motion Re(u exp(lambda t)) of the sliding brake at a speed (rad/s), from
/// its linearised contact forces.
/// @param u  eigenvector of the state matrix for the oscillating eigenvalue lambda
PeriodWork period_work(const FlexibleDisc& brake, double speed, std::complex<double> lambda,
                       const Eigen::VectorXcd& u);

}  // namespace chladni::squeal
