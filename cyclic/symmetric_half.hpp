#pragma once

#include "cyclic/harmonic_coordinates.hpp"
#include "reduce/reduction.hpp"

namespace chladni::cyclic {

/// The symmetric half of a harmonic whose sector has a mirror, as coordinates of their own: X B and
/// Y B with the symmetric motions B. A master stands for all that the mirror mixes with it.
HarmonicCoordinates symmetric_half(const HarmonicCoordinates& c);

/// The masters of a harmonic as sums of those of its symmetric half and of J of these.
struct MasterHalves {
  Eigen::MatrixXd now;    ///< [n_masters x n_masters / 2]
  Eigen::MatrixXd later;  ///< the same a quarter of a period later
};
MasterHalves master_halves(const HarmonicCoordinates& c, const HarmonicCoordinates& half);

/// A form of the half in the masters and modes of the whole: its masters, then of each mode of the
/// half the mode and the same a quarter of a period later.
/// @param A  [n_masters / 2 + n_modes squared]
Eigen::MatrixXd unfolded_form(const Eigen::MatrixXd& A, const MasterHalves& masters);

/// Rows of a transformation from masters and modes of the half, for those of the whole.
/// @param half  [k x n_masters / 2 + n_modes] of the symmetric motions
SectorMotion unfolded_motion(const SectorMotion& half, const MasterHalves& masters);

/// Each eigenvalue of the half twice.
reduce::Certificate unfolded_certificate(const reduce::Certificate& half);

}  // namespace chladni::cyclic
