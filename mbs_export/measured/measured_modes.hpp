#pragma once

#include <Eigen/Core>

#include <complex>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {

/// A point of a measurement.
struct MeasuredNode {
  std::int64_t number;
  Eigen::Vector3d position;  ///< m
};

/// Mode shapes from an experiment.
struct MeasuredModes {
  std::vector<MeasuredNode> nodes;  ///< [n] at which the shapes are known
  Eigen::VectorXd f_Hz;             ///< [k]
  std::vector<std::string> names;   ///< [k] first line of text of each shape
  /// [3 n x k] x, y, z of each node in turn, in arbitrary units
  Eigen::MatrixXcd shapes;
  std::vector<std::string> notes = {};  ///< on what was left out
};

/// Reads the modes of a universal file: the nodes (datasets 15, 2411), and normal and complex modes
/// (dataset 55 in ASCII, of analysis 2 and 3) of translations. Rotations are left out; other
/// datasets and results that are no modes are left out with a note.
/// @param metres  m per unit of length of the file; needed if it has no units (164)
/// @throws chladni::Error naming file, line and record for a violation of the format, for
///         coordinate systems of its own, shapes at other nodes than those of the first one,
///         lengths without a unit, and for a file without any shape.
/// Source: SDRC, Universal Dataset Numbers 15, 55, 164 and 2411.
MeasuredModes read_measured_modes(const std::filesystem::path& path, std::optional<double> metres);

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
