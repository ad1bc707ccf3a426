#pragma once

#include "cases/reduce_steps.hpp"

namespace chladni::cases {

/// What a reduction takes of the FE model of a scene, which loses its matrices; viewed before where
/// options say so. Refers to the model, for the names of its DOFs.
/// @note   Collective.
reduce::Body body_of(const scene::Scene& scene, FeModel& fe);

}  // namespace chladni::cases
