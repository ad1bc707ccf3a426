#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cyclic/harmonic_coordinates.hpp"

namespace chladni::cyclic {

/// The mirror plane of a sector whose cut edges are straight and are mirror images of each other.
/// @param positions  [n_blocks x 3] m, of the nodes of the blocks
/// @param forms      matrices of the sector; empty ones are ignored
/// @return absent if positions or a form are not symmetric to it
std::optional<Mirror> find_mirror(const SectorDofs& sector, const Eigen::MatrixX3d& positions,
                                  const std::vector<const SparseRows*>& forms);

/// The motions that the mirror leaves unchanged: half of those of a harmonic with two phases. Each
/// eigenspace is double because of J; one direction of it is symmetric, and J of it is the other.
/// @param sector  with its mirror
/// @return [n x n / 2] orthonormal, with a few entries in each column
SparseRows symmetric_motions(const HarmonicCoordinates& c, const SectorDofs& sector);

}  // namespace chladni::cyclic
