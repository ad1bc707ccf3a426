#pragma once

#include "cases/harmonic_part.hpp"

namespace chladni::cases {

/// The section forces of all sectors from those of the first: `section_forces` in axes that turn
/// with the sector. Element numbers of later sectors continue after the largest of the first.
/// @param parts      with the motion of all DOFs of the sector
/// @param n          number of coordinates of the whole body
/// @param n_masters  number of masters among them
/// @throws chladni::Error as `section_forces`.
std::vector<mbs_export::ResultantModes> sector_forces(const scene::Scene& scene,
                                                      const SectorModel& model,
                                                      const std::vector<HarmonicPart>& parts,
                                                      Eigen::Index n, Eigen::Index n_masters);

}  // namespace chladni::cases
