#pragma once

#include <string>
#include <vector>

#include "cases/fe_model.hpp"
#include "linear/solver_options.hpp"
#include "mbs_export/inertia.hpp"

namespace chladni::cases {

/// The mass integrals of the FE model in the coordinates of the reduced system.
/// @note   Collective.
mbs_export::MassIntegrals mass_integrals(const plate::Structure& structure, const FeModel& fe,
                                         const SceneReduction& reduced);

/// Static displacements of the FE model under inertial forces, whose stress stiffens it.
struct StressedStates {
  std::vector<std::string> loads;  ///< some of mbs_export::stiffening_loads, in their order
  /// [12 x n_loads] loads on the mass as by `mass_load`, with the inertia of a free acceleration.
  Eigen::Matrix<double, 12, Eigen::Dynamic> mass_loads;
  petsc::Matrix U;  ///< [n_DOFs x n_loads] dense, for a unit factor of each; null if none
};

/// The action on the mass of a load of mbs_export::stiffening_loads: its factors in the columns of
/// plate::MassMoments::displacement.
Eigen::Vector<double, 12> mass_load(const std::string& load);

/// The inertial force of a rigid body whose point at `centre` [m] has the acceleration (a_x, a_y,
/// a_z) [m/s^2] and which has the angular acceleration (alpha_x, alpha_y, alpha_z) [rad/s^2], in
/// the terms of `mass_load`.
Eigen::Vector<double, 12> inertial_load(const Eigen::Vector<double, 6>& acceleration,
                                        const Eigen::Vector3d& centre);

/// The displacements under the loads of `reduce.stiffening`, with the support of the body. Rigid
/// motions that it leaves accelerate freely, and their inertia balances the load. Needs the
/// matrices of `fe`. The result is empty if the scene asks for no load.
/// @note   Collective.
/// @throws chladni::Error on all ranks for a support that holds nodes of a ring of harmonics, and
///         for a body that springs to the ground, or averaging couplings, hold in part only.
StressedStates stressed_states(const scene::Scene& scene, const FeModel& fe,
                               const linear::SolverOptions& options, Phases& phases);

/// The geometric stiffness of the FE model in the coordinates of the reduced system, for each load.
/// @note   Collective.
mbs_export::Stiffening stiffening(const scene::Scene& scene, const FeModel& fe,
                                  const SceneReduction& reduced, const StressedStates& stressed);

}  // namespace chladni::cases
