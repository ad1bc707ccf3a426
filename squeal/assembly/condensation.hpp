#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/assembly/assembly.hpp"

namespace chladni::squeal {

/// What condensed bodies must keep.
struct CondensationOptions {
  double tolerance;             ///< largest relative error of an eigenvalue of the band
  double highest;               ///< end of the band, rad/s
  double speed_from, speed_to;  ///< rad/s
};

/// Bodies that move as they do in the vibrations of one brake, and what that costs.
struct CondensedBodies {
  std::vector<mbs_export::ModalBody> bodies;  ///< of the parts, in their order
  double error;       ///< largest relative error of an eigenvalue of the band, all samples
  int n_samples;      ///< pairs of speed and friction from which the shapes were taken
  int n_eigenvalues;  ///< compared, of all samples
};

/// Condenses each body of an assembly to the shapes that it takes in the eigenvectors of the whole
/// brake within a band: principal components of its share, weighted by energy, of all eigenvectors
/// at the ends of the speed range, without friction and with it. Shapes of the disc are taken with
/// all their rotations, so that it stays axisymmetric. As many shapes are kept, the largest first,
/// as keep the eigenvalues of the band within the tolerance, both ways: each one is found, and none
/// is found that is not one. The middle of speeds and frictions is a check; where it does not keep
/// the tolerance, it becomes a sample.
/// Rigid-body motions and modes that have no share in the band are lost: the bodies are those of
/// this brake.
/// @param bodies  of the parts, in their order
/// @throws chladni::Error as `assembly`; when the band has no eigenvalue; and when all shapes
///         together do not keep the tolerance.
CondensedBodies condense(const AssemblyOptions& options,
                         std::span<const mbs_export::ModalBody> bodies,
                         const CondensationOptions& wanted);

}  // namespace chladni::squeal
