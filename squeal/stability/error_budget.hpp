#pragma once

#include <Eigen/Core>

#include <complex>
#include <functional>
#include <optional>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

/// First-order estimate of the error of a growth rate due to the body, 1/s. The errors of modal
/// frequencies and ring motions are multiplied by the sensitivities of the growth rate to them and
/// added without sign. Parts for which the body has no data are absent; so are all except
/// `left_out` when the oscillation is beyond the range of known errors. Where two eigenvalues
/// nearly coincide the sensitivities, and with them the estimate, are too large.
/// @param brake   brake with an inertial frame
/// @param speed   rad/s
/// @param lambda  eigenvalue of its state matrix at this speed; the nearest is taken
ErrorBudget growth_error_budget(const FlexibleDisc& brake, double speed,
                                const std::complex<double>& lambda);

/// The same of a critical speed, rad/s: errors of the growth rate there over its slope.
/// @param brake  brake with an inertial frame, critical within its range of speeds
ErrorBudget error_budget(const FlexibleDisc& brake, const CriticalSpeed& critical);

/// Multiplies some numbers of a disc by a factor.
using DiscScaling = std::function<void(InertialDisc& disc, double factor)>;

/// Derivatives of some results by the logarithm of what is scaled, [n_results].
using DerivativeByDisc = std::function<Eigen::VectorXd(const DiscScaling& scale)>;

/// Errors of some results due to the body, each [n_results]; absent where the body does not know
/// the errors of its modes.
struct ErrorsByModes {
  std::optional<Eigen::VectorXd> mesh = {}, reduction = {}, body = {};

  /// The parts of the error of one result.
  ErrorBudget budget(Eigen::Index result) const;
};

/// First-order estimate of the errors that the errors of a disc's modes cause: errors of
/// frequencies and ring motions times the derivatives by them, added without sign.
/// @param omega  of the motion that the results describe, rad/s; beyond the range of known errors
///               there are none
ErrorsByModes errors_by_modes(const InertialDisc& disc, double omega, Eigen::Index n_results,
                              const DerivativeByDisc& derivative);

/// The part of the error by the mesh that finer elements cause by the compliance under the pads.
Eigen::VectorXd errors_by_compliance(const InertialDisc& disc, Eigen::Index n_results,
                                     const DerivativeByDisc& derivative);

/// Adds this compliance itself, (factor - 1) times, to all functions of all rings.
DiscScaling finer_under_the_pads(const InertialDisc& disc);

}  // namespace chladni::squeal
