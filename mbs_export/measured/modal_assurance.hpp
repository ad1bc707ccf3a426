#pragma once

#include <Eigen/Core>
#include <vector>

#include "mbs_export/measured/measured_modes.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {

/// A measured node and the place at which it was found on the body.
struct MatchedNode {
  std::int64_t number;       ///< of the measurement
  Eigen::Vector3d position;  ///< m, of the body's node
  double distance;           ///< m, between both
};

/// The comparison of measured shapes with the modes of a body.
struct ModalAssurance {
  std::vector<MatchedNode> nodes;
  /// Number of compared components: of the 3 of each node, those that were measured.
  Eigen::Index n_components;
  std::vector<int> modes;       ///< [m] numbers of the body's modes, from 1
  Eigen::VectorXd body_Hz;      ///< [m]
  Eigen::VectorXd measured_Hz;  ///< [k]
  Eigen::MatrixXd mac;          ///< [k x m]
};

/// MAC = |psi^H phi|^2 / (psi^H psi phi^T phi) of each measured shape psi and each mode phi of the
/// body. A measured node is compared with the nearest node of the body, of its picture or an
/// attachment node. Interface modes are no natural modes and are left out. A component that is
/// exactly zero in every measured shape counts as not measured and is left out.
/// @param distance  m; largest distance between a measured node and the nearest node
/// @throws chladni::Error naming the measured nodes that are farther away, two that have the same
///         node of the body, and a shape or mode that is zero at all nodes.
/// Source: Allemang, Brown, Proc. 1st IMAC (1982) 110.
ModalAssurance modal_assurance(const ModalBody& body, const MeasuredModes& measured,
                               double distance);

}  // namespace chladni::mbs_export
