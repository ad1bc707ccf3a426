#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

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
