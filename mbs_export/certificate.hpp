#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace chladni::mbs_export {

/// Eigenvalues of omega^2 below a frequency: of the FE model by Sylvester's law, of the reduced
/// one by looking.
struct ModeCount {
  double up_to = 0.0;  ///< rad/s; 0 where nothing was counted
  int expected = 0;
  int found = 0;

  int missing() const { return expected - found; }
};

/// Responses to harmonic loads at masters, compared with those of the FE model.
struct ResponseCheck {
  double up_to = 0.0;              ///< rad/s
  double error = 0.0;              ///< upper bound, relative
  std::vector<std::string> loads;  ///< "track.z" stands for all nodes of the set
};

/// How good a reduced system is, made at the time of the reduction, when the FE model is at hand.
/// Empty when nobody looked.
struct Certificate {
  std::vector<std::string> fixed;  ///< the support, as BodyOptions::fixed
  Eigen::VectorXd frequencies;     ///< [k] rad/s, of the elastic modes, ascending
  Eigen::VectorXd eta2;            ///< [k] estimated relative error of omega^2 against the FE model
  Eigen::VectorXd estimates{};     ///< [k] estimated relative errors of `frequencies`, by place
  Eigen::VectorXd rounding{};      ///< [k] what rounding of K may add to it; empty in old files
  Eigen::VectorXd bounds;          ///< [<= k] of it, rounding included, of modes that are counted
  ModeCount fixed_interface;       ///< modes with all masters held, up to the last one kept
  ModeCount range;                 ///< modes under the support, up to the last frequency
  ModeCount complete;              ///< the largest range looked at in which none is missing
  int n_rigid = 0;                 ///< zero-energy motions of the free body
  double rigid_residual = 0.0;     ///< their energy over the first elastic omega^2; 0 is perfect
  double condition = 0.0;          ///< estimate for K_ss; 0 where unknown
  double count_share = 0.0;        ///< of a count in the reduction's work; 0 where unknown, no file
  std::optional<ResponseCheck> responses = {};
  /// [6 x mesh_errors] estimated relative errors by the mesh of the radial, circumferential and
  /// axial displacements of the interface nodes, and of their rotations about these directions
  Eigen::MatrixXd mesh_shape_errors{};
  Eigen::VectorXd mesh_errors{};  ///< [<= k] estimated relative errors of `frequencies` by the mesh
};

/// The estimated relative error of each frequency, what a user reads: `estimates`, or in files
/// without them half of eta^2.
Eigen::VectorXd estimated_errors(const Certificate& certificate);

}  // namespace chladni::mbs_export
