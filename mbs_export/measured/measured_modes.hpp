#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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
};

/// Reads the modes of a universal file in ASCII: the nodes (datasets 15, 2411), and normal and
/// complex modes (dataset 55 of analysis 2 and 3) of translations. Rotations are left out, trace
/// lines and headers (82, 151) are ignored.
/// @param metres  m per unit of length of the file; needed if it has no units (164)
/// @throws chladni::Error naming file, line and record for a violation of the format, for another
///         dataset, a binary one, coordinate systems of its own, shapes at other nodes than those
///         of the first one, and lengths without a unit.
/// Source: SDRC, Universal Dataset Numbers 15, 55, 164 and 2411.
MeasuredModes read_measured_modes(const std::filesystem::path& path, std::optional<double> metres);

}  // namespace chladni::mbs_export
