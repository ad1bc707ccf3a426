#pragma once

#include <vector>

#include "cases/sector_model.hpp"
#include "reduce/reduction.hpp"

namespace chladni::cases {

/// The rank that reduces a harmonic.
int rank_of_harmonic(int order);

/// The harmonics that this rank reduces, ascending.
std::vector<int> own_harmonics(int count);

/// @throws chladni::Error for a method that harmonics do not know.
void check_method(reduce::Method method);

/// How each harmonic is reduced: a number of modes of the whole body becomes the frequency below
/// which it has them.
/// @note   Collective on all ranks.
/// @throws chladni::Error for a method that harmonics do not know.
reduce::ReductionOptions harmonic_options(const scene::Scene& scene, const SectorModel& model,
                                          const cyclic::SectorMatrices& matrices,
                                          const linear::SolverOptions& solver);

}  // namespace chladni::cases
