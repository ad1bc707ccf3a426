#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace chladni::mbs_export {

/// A place where a measurement was taken.
struct MeasuredNode {
  std::int64_t number;
  Eigen::Vector3d position;  ///< m
};

/// Shapes of vibration that an experiment found.
struct MeasuredModes {
  std::vector<MeasuredNode> nodes;  ///< [n] of the shapes
  Eigen::VectorXd f_Hz;             ///< [k]
  std::vector<std::string> names;   ///< [k] the first line of words of each
  /// [3 n x k] x, y, z of each node in turn; their unit has no meaning
  Eigen::MatrixXcd shapes;
};

/// The modes of a universal file in ASCII: normal modes and complex modes (dataset 55 of analysis 2
/// and 3) of translations, or of translations with rotations, which are left out; and the nodes
/// (15, 2411). Trace lines and headers (82, 151) are passed over.
/// @param metres  of a unit of length of the file, where it has no units (164)
/// @throws chladni::Error naming file, line and record for what is not as the format says, for
/// another
///         dataset, a binary one, coordinate systems of its own, shapes at other nodes than the
///         first one, and lengths without a unit.
/// Source: SDRC, Universal Dataset Numbers 15, 55, 164 and 2411.
MeasuredModes read_measured_modes(const std::filesystem::path& path, std::optional<double> metres);

}  // namespace chladni::mbs_export
