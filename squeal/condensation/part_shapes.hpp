#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/assembly/assembly.hpp"
#include "squeal/stability/band_modes.hpp"

namespace chladni::squeal {

/// What the parts of a brake do in some of its eigenvectors, each of which has the energy one.
struct PartMotions {
  Eigen::MatrixXcd disc;                ///< [n_disc x k] coordinates of the inertial disc
  std::vector<Eigen::MatrixXcd> parts;  ///< [n_i x k] modes of each part; empty for the disc
};

/// @param modes  of the state matrix of `all`
PartMotions part_motions(const Assembly& all, const AssemblyOptions& options,
                         std::span<const mbs_export::ModalBody> bodies, const BandModes& modes);

/// A shape that a part takes: a linear combination of the modes of its body, or for the disc the
/// two that turn into each other.
struct PartShape {
  std::size_t part;
  Eigen::MatrixXd columns;  ///< [n_modes x 1 or 2]
  double size;              ///< root mean square of its energy over the eigenvectors
};

/// Principal components of the motions of each part, the largest of all parts first. Those of the
/// disc are components of each number of nodal diameters, in all positions alike. Components below
/// 1e-8 of the largest one are left out.
/// @param omega  by which displacements are weighted beside the frequencies, rad/s
std::vector<PartShape> principal_shapes(const Assembly& all, const AssemblyOptions& options,
                                        std::span<const mbs_export::ModalBody> bodies,
                                        std::span<const PartMotions> motions, double omega);

/// The shapes of one part side by side.
/// @return [n_modes x k]
Eigen::MatrixXd columns_of(std::span<const PartShape> shapes, std::size_t part,
                           Eigen::Index n_modes);

}  // namespace chladni::squeal
