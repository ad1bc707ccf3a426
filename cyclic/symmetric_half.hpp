#pragma once

#include "cyclic/harmonic_coordinates.hpp"
#include "reduce/reduction.hpp"

namespace chladni::cyclic {

/// The symmetric half of a harmonic whose sector has a mirror, as coordinates X B and Y B with the
/// symmetric motions B. A master represents all masters that the mirror mixes with it.
HarmonicCoordinates symmetric_half(const HarmonicCoordinates& c);

/// The masters of a harmonic as sums of those of its symmetric half and of J of these.
struct MasterHalves {
  Eigen::MatrixXd now;    ///< [n_masters x n_masters / 2]
  Eigen::MatrixXd later;  ///< of J of them, a quarter of a period later
};
/// The two parts of the masters of a harmonic.
MasterHalves master_halves(const HarmonicCoordinates& c, const HarmonicCoordinates& half);

/// A form of the half in the masters and modes of the whole: its masters, then for each mode of the
/// half this mode and the same mode a quarter of a period later.
/// @param A  [n_masters / 2 + n_modes squared]
Eigen::MatrixXd unfolded_form(const Eigen::MatrixXd& A, const MasterHalves& masters);

/// The rows of a transformation in the masters and modes of the whole, from those of the half.
/// @param half  [k x n_masters / 2 + n_modes] of the symmetric motions
SectorMotion unfolded_motion(const SectorMotion& half, const MasterHalves& masters);

/// The certificate of the whole: each eigenvalue of the half appears twice.
reduce::Certificate unfolded_certificate(const reduce::Certificate& half);

}  // namespace chladni::cyclic
