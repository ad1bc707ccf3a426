#pragma once

#include <optional>

#include "cases/sector_model.hpp"
#include "cyclic/harmonic_model.hpp"

namespace chladni::cases {

/// The assembled matrices of the sector.
/// @param comm  of the ranks that reduce a harmonic together
cyclic::SectorMatrices matrices_of(const SectorModel& model, MPI_Comm comm);

/// The mirror plane of positions and matrices; absent if the sector has none.
std::optional<cyclic::Mirror> mirror_of(const SectorModel& model,
                                        const cyclic::SectorMatrices& matrices);

}  // namespace chladni::cases
