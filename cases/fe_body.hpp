#pragma once

#include "cases/reduce_steps.hpp"

namespace chladni::cases {

/// True if the zero-energy motions are the rigid-body motions of the nodes: no spring goes to the
/// ground, and no node moves by a combination of other DOFs.
bool geometry_tells_motions(const scene::Scene& scene, const FeModel& fe);

/// The input of the reduction, taken from the FE model of a scene, which loses its matrices. They
/// are viewed before if options say so. The result refers to the model for the names of its DOFs.
/// @note   Collective.
reduce::Body body_of(const scene::Scene& scene, FeModel& fe);

}  // namespace chladni::cases
