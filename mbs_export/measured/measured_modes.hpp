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

}  // namespace chladni::mbs_export
