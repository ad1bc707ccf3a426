#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cyclic/harmonic_coordinates.hpp"

namespace chladni::cyclic {

/// The mirror of a sector whose cut edges are straight and look alike from both sides.
/// @param positions  [n_blocks x 3] m, of the nodes of the blocks
/// @param forms      matrices of the sector; empty ones count for nothing
/// @return nothing where positions or one of the forms do not agree with it
std::optional<Mirror> find_mirror(const SectorDofs& sector, const Eigen::MatrixX3d& positions,
                                  const std::vector<const SparseRows*>& forms);

/// The motions that the mirror leaves as they are: half of those of a harmonic with two phases. In
/// each eigenspace, which J makes double, it leaves one direction; J of it is the other.
/// @param sector  with its mirror
/// @return [n x n / 2] orthonormal, a few entries in each column
SparseRows symmetric_motions(const HarmonicCoordinates& c, const SectorDofs& sector);

}  // namespace chladni::cyclic
