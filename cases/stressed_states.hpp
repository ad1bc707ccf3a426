#pragma once

#include <string>
#include <vector>

#include "cases/reduce_steps.hpp"
#include "linear/solver_options.hpp"

namespace chladni::cases {

/// Static displacements of the FE model under inertial forces, whose stress stiffens it.
struct StressedStates {
  std::vector<std::string> loads;  ///< some of mbs_export::stiffening_loads, in their order
  /// [12 x n_loads] on the mass, with the inertia of a free acceleration: as `mass_load`
  Eigen::Matrix<double, 12, Eigen::Dynamic> mass_loads;
  petsc::Matrix U;  ///< [n_DOFs x n_loads] dense, for a factor 1 of each; null if none
};

/// How a load of mbs_export::stiffening_loads acts on the mass: its parts in the columns of
/// plate::MassMoments::displacement.
Eigen::Vector<double, 12> mass_load(const std::string& load);

/// The inertial force of a rigid body whose point at `centre` [m] has the acceleration
/// (a_x, a_y, a_z) [m/s^2] and which has the angular acceleration (alpha_x, alpha_y, alpha_z)
/// [rad/s^2], in the terms of `mass_load`.
Eigen::Vector<double, 12> inertial_load(const Eigen::Vector<double, 6>& acceleration,
                                        const Eigen::Vector3d& centre);

/// The displacements under the loads of `reduce.stiffening`, with the support of the body. What
/// rigid motions it leaves accelerate freely: their inertia balances the load. Needs the matrices
/// of `fe`; nothing is done where the scene asks for no load.
/// @note   Collective.
/// @throws chladni::Error on all ranks for a support that holds nodes of a ring of harmonics, and
///         for a body that springs to the ground, or means, hold in part only.
StressedStates stressed_states(const scene::Scene& scene, const FeModel& fe,
                               const linear::SolverOptions& options, Phases& phases);

}  // namespace chladni::cases
