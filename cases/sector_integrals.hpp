#pragma once

#include "cases/harmonic_part.hpp"
#include "mbs_export/mass_integrals.hpp"

namespace chladni::cases {

/// The integrals over the mass of the whole body, from the contributions of the harmonics.
/// @param M  of the whole body, [n x n]
mbs_export::MassIntegrals sector_integrals(const SectorMass& mass,
                                           const std::vector<HarmonicPart>& parts,
                                           const Eigen::MatrixXd& M, Eigen::Index n_masters);

}  // namespace chladni::cases
