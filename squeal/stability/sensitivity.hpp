#pragma once

#include <optional>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/sensitivity_results.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// Derivatives of the critical speed within `options.speeds`, and of the growth rates at
/// `options.gradients`, by each parameter of the brake and by the frequency of each mode or pair of
/// its disc (at constant damping in 1/s). With left and right eigenvectors,
///   d lambda / dp = l^T (dA/dp) r,
/// and at the critical speed, where Re lambda(Omega, p) = 0, by the implicit function theorem
///   d Omega_c / dp = -(Re d lambda / dp) / (Re d lambda / d Omega).
/// dA/dp are central differences of second order with a step of 1e-5 of the value, with a relative
/// error of about 1e-10. For a value of zero they are one-sided differences of second order with
/// 1e-5 of the change that changes A by its own size.
/// @throws chladni::Error when there is neither a critical speed in the range nor a speed of growth
///         rates, and for a disc that is not axisymmetric.
Gradients gradients(const Brake& brake, const StudyOptions& options);

/// The same of a disc that is not axisymmetric, by each parameter and the frequency of each mode:
/// d lambda / dp is the mean of l^T (dA/dp) r over the turn, with the motion r(phi) and its left
/// vector. Up to five motions; see Hill::motions.
/// @param critical  its critical speed, absent where there is none
/// @throws chladni::Error as `gradients`, and as Hill's method.
Gradients turning_gradients(const FlexibleDisc& brake, const StudyOptions& options,
                            const std::optional<CriticalSpeed>& critical);

/// Influence of the modes on the critical speed: its values with the lowest 2, 8, 16 and all modes,
/// and its change and the growth rate at it when one mode or pair of modes is left out.
/// @throws chladni::Error when there is no critical speed in the range.
ModeSensitivity mode_sensitivity(const InertialDisc& disc, const SquealOptions& options);

}  // namespace chladni::squeal
