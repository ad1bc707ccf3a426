#pragma once

#include <Eigen/Core>
#include <vector>

#include "mbs_export/measured/measured_modes.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {

/// Where a measured node was found on the body.
struct MatchedNode {
  std::int64_t number;       ///< of the measurement
  Eigen::Vector3d position;  ///< m, of the body's node
  double distance;           ///< m
};

/// Measured shapes beside the modes of a body.
struct ModalAssurance {
  std::vector<MatchedNode> nodes;
  Eigen::Index n_components;    ///< that were compared: of 3 of each node those that were measured
  std::vector<int> modes;       ///< [m] numbers of the body's modes, from 1
  Eigen::VectorXd body_Hz;      ///< [m]
  Eigen::VectorXd measured_Hz;  ///< [k]
  Eigen::MatrixXd mac;          ///< [k x m]
};

/// MAC = |psi^H phi|^2 / (psi^H psi phi^T phi) of each measured shape psi and each mode phi of the
/// body, at the node of the body (of its picture, or an attachment node) that is nearest to each
/// measured one. Interface modes are no natural modes and are left out. A component at which every
/// measured shape is exactly zero was not measured, and is not compared.
/// @param distance  m; how far a measured node may be from the nearest one
/// @throws chladni::Error naming the measured nodes that are farther, two that have the same node
/// of
///         the body, and a shape or mode that is zero at all nodes.
/// Source: Allemang, Brown, Proc. 1st IMAC (1982) 110.
ModalAssurance modal_assurance(const ModalBody& body, const MeasuredModes& measured,
                               double distance);

}  // namespace chladni::mbs_export
