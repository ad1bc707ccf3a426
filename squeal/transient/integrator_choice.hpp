#pragma once

#include <optional>
#include <string>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// How to integrate a transient.
struct IntegratorChoice {
  IntegratorKind kind;   ///< never automatic
  int steps_per_period;  ///< of the highest mode: with fixed steps, and at least with adaptive ones
  double tolerance;      ///< of adaptive steps: error of a step, relative to |y|
  std::string reason;    ///< why, for people
};

/// The choice of the scene, or for "auto" the cheapest integrator that keeps `growth_error`:
/// "generalised-alpha" when the disc with its pads at rest is stiff, that is when something decays
/// faster than the highest mode oscillates, or when it becomes so where the start of the run may
/// stop a pad on the disc; else "exponential" for an axisymmetric disc; else
/// "splitting" unless its step would be so small that "dormand-prince" costs less. The error of a
/// step length is that of the eigenvalues of the discrete motion near the sliding equilibrium.
/// @throws chladni::Error when "exponential" is asked for and the disc is not axisymmetric.
IntegratorChoice choose_integrator(const Disc& disc, const std::optional<InertialDisc>& inertial,
                                   const SquealOptions& options, const TransientCase& run);

/// "splitting", ...; as in the scene.
const char* name_of(IntegratorKind kind);

/// Largest error (1/s) that steps of the splitting or of the generalised-alpha method add to a
/// growth rate near the sliding equilibrium; 0 for the other kinds. Exact for the
/// splitting, the leading term for the other one.
double growth_error_of(IntegratorKind kind, const InertialDisc& disc, const SquealOptions& options,
                       double speed, int steps_per_period);

}  // namespace chladni::squeal
