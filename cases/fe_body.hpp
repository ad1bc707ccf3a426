#pragma once

#include "cases/reduce_steps.hpp"

namespace chladni::cases {

/// Whether the rigid-body motions are those of the nodes, and no spring resists them.
bool geometry_tells_motions(const scene::Scene& scene, const FeModel& fe);

/// What a reduction takes of the FE model of a scene, which loses its matrices; viewed before where
/// options say so. Refers to the model, for the names of its DOFs.
/// @note   Collective.
reduce::Body body_of(const scene::Scene& scene, FeModel& fe);

}  // namespace chladni::cases
