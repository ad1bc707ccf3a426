#pragma once

#include "cases/harmonic_part.hpp"
#include "mbs_export/mass_integrals.hpp"

namespace chladni::cases {

/// Integrals over the mass of the whole body from those of its sector: a turn by one sector takes
/// x to R x, so that each is a sum over the sectors of products with R and the phases. Harmonics of
/// which neither sum nor difference is 0, 1 or 2 have nothing in common.
/// @param parts  with the motion of all DOFs of the sector
/// @param M      of the whole body, [n x n]
mbs_export::MassIntegrals sector_integrals(const scene::Scene& scene, const SectorModel& model,
                                           const std::vector<HarmonicPart>& parts,
                                           const Eigen::MatrixXd& M, Eigen::Index n_masters);

}  // namespace chladni::cases
