#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace chladni::mbs_export {

/// The number of eigenvalues omega^2 below a frequency: of the FE model, counted by Sylvester's
/// law, and of the reduced system.
struct ModeCount {
  double up_to = 0.0;  ///< rad/s; 0 if nothing was counted
  int expected = 0;    ///< of the FE model
  int found = 0;       ///< of the reduced system

  int missing() const { return expected - found; }
};

/// The error of responses to harmonic loads at masters, against those of the FE model.
struct ResponseCheck {
  double up_to = 0.0;              ///< rad/s
  double error = 0.0;              ///< upper bound, relative
  std::vector<std::string> loads;  ///< "track.z" for all nodes of a set
};

/// How much the displacement of a node by a force at this node alone grows when all elements are
/// halved, means of some nodes of each set. A force at a point of a shear-flexible shell, or a
/// moment, has no finite displacement: it grows by about the same for each halving.
struct OwnCompliances {
  std::vector<std::string> sets;  ///< of attachment nodes
  /// [3 x n_sets] along the z axis and across it, m/N; of rotations across it, rad/(N m)
  Eigen::MatrixXd growth;
};

/// The accuracy of a reduced system, found at the time of the reduction, when the FE model is at
/// hand. Empty if it was not determined.
struct Certificate {
  std::vector<std::string> fixed;  ///< the support, as BodyOptions::fixed
  Eigen::VectorXd frequencies;     ///< [k] rad/s, of the elastic modes, ascending
  Eigen::VectorXd eta2;            ///< [k] estimated relative error of omega^2 against the FE model
  /// [k] estimated relative errors of `frequencies`, by their place in the order
  Eigen::VectorXd estimates{};
  /// [k] relative errors of omega^2 by rounding of K, in addition to eta2; empty in old files
  Eigen::VectorXd rounding{};
  /// [<= k] upper bounds of the relative errors of omega^2, rounding included, of counted modes
  Eigen::VectorXd bounds;
  ModeCount fixed_interface;    ///< modes with all masters held, up to the last one kept
  ModeCount range;              ///< modes under the support, up to the last frequency
  ModeCount complete;           ///< the largest counted range in which none is missing
  int n_rigid = 0;              ///< number of zero-energy motions of the free body
  double rigid_residual = 0.0;  ///< their energy over the first elastic omega^2; 0 is perfect
  double condition = 0.0;       ///< estimated condition number of K_ss; 0 if unknown
  /// Share of the counts in the work of the reduction; 0 if unknown; not in the file.
  double count_share = 0.0;
  std::optional<ResponseCheck> responses = {};
  /// [6 x number of mesh_errors] estimated relative errors by the mesh of the radial,
  /// circumferential and axial displacements of the interface nodes, and of their rotations about
  /// these directions
  Eigen::MatrixXd mesh_shape_errors{};
  /// [<= k] estimated relative errors of `frequencies` by the mesh
  Eigen::VectorXd mesh_errors{};
  OwnCompliances mesh_compliances = {};  ///< with `mesh_errors`; empty if unknown
};

/// The estimated relative error of each frequency that is shown to users: `estimates`, or half of
/// eta^2 for files without them.
Eigen::VectorXd estimated_errors(const Certificate& certificate);

}  // namespace chladni::mbs_export
