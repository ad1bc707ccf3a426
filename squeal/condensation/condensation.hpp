#pragma once

#include <Eigen/Core>

#include <span>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/assembly_options.hpp"

namespace chladni::squeal {

/// What condensed bodies must keep.
struct CondensationOptions {
  double tolerance;  ///< largest relative error of an eigenvalue of the band
  /// End of the band, rad/s: all oscillations with Im(lambda) up to here, whatever their damping.
  double highest;
  double speed_from, speed_to;  ///< rad/s
  std::string brake = {};       ///< title of the scene, for the bodies
};

/// How well a brake of condensed bodies does what that of the complete bodies does.
struct CondensationError {
  double eigenvalues = 0.0;  ///< largest relative error of one of the band, all states
  double growth = 0.0;       ///< largest error of the real part of one of them, 1/s
  int n_eigenvalues = 0;     ///< compared, of all states
  int n_states = 0;          ///< pairs of speed and friction that were compared
  /// Motions beyond the band that grow with the condensed bodies, at most in one of the states.
  int n_unstable_beyond = 0;
};

/// Bodies that move as they do in the vibrations of one brake.
struct CondensedBodies {
  std::vector<mbs_export::ModalBody> bodies;  ///< of the parts, in their order
  CondensationError error;
};

/// Condenses each body of an assembly to the shapes that it takes in the eigenvectors of the whole
/// brake within a band: principal components of its share, weighted by energy, of all eigenvectors
/// at the ends of the speed range, without friction and with it. Shapes of the disc are taken in
/// all positions, so that it stays axisymmetric. Shapes are kept by size, as many as bisection
/// finds to keep the tolerance: each eigenvalue of the band has one of its own within it, no other
/// is in the band, and what grows or decays by more than 1e-4 of its frequency still does so.
/// States between the ends are checks; one that fails becomes a sample, and shapes are chosen
/// again.
/// Rigid-body motions and whatever has no share in the band are lost: the bodies are those of this
/// brake. Motions beyond the band are not the brake's.
/// @param bodies  of the parts, in their order
/// @throws chladni::Error as `assembly`; when the band has no oscillation; and when all shapes
///         together do not keep the tolerance.
CondensedBodies condense(const AssemblyOptions& options,
                         std::span<const mbs_export::ModalBody> bodies,
                         const CondensationOptions& wanted);

/// Compares the oscillations of a band with those of another state matrix, one with one.
/// @param exact    eigenvalues of the band, 1/s
/// @param A        of the condensed brake
/// @param wanted   band and tolerance
/// @return eigenvalues = 1 where one of the band is found that is none, or where one that grows or
///         decays by more than 1e-4 of its frequency does the opposite
CondensationError condensation_error(const Eigen::VectorXcd& exact, const Eigen::MatrixXd& A,
                                     const CondensationOptions& wanted);

/// The worst of both; numbers of eigenvalues and states add up.
CondensationError worst_of(const CondensationError& one, const CondensationError& other);

}  // namespace chladni::squeal
