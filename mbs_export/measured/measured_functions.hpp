#pragma once

#include <Eigen/Core>

#include <complex>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/responses/response_options.hpp"

namespace chladni::mbs_export {

/// A node and a component of a measurement.
struct MeasuredDof {
  std::int64_t node;
  int component;  ///< 0 to 5, in the positive direction of the axis
};

/// A frequency response from an experiment.
struct MeasuredFunction {
  std::size_t line;  ///< of the file, where its dataset begins
  std::string name;  ///< first line of text
  MeasuredDof output, load;
  std::optional<ResponseQuantity> quantity;  ///< nothing where the file does not say it
  /// [n_f] in units of the SI: m or rad per N or N m, divided by s or s^2
  Eigen::VectorXcd H;
};

/// A node of a measurement that has frequency responses.
struct MeasuredPlace {
  Eigen::Vector3d position;  ///< m
  bool is_in_global_axes;    ///< false where its directions are those of a system of its own
};

/// The frequency responses of a universal file.
struct MeasuredFunctions {
  std::string file;
  Eigen::VectorXd f_Hz;  ///< [n_f] ascending, of all functions
  std::vector<MeasuredFunction> functions;
  std::map<std::int64_t, MeasuredPlace> nodes;  ///< empty where the file has none
  std::vector<std::string> notes;  ///< on what was left out, and on what the file does not say
};

/// Reads the frequency response functions of a universal file: dataset 58 of type 4, real or
/// complex, in single or double precision, at even or uneven frequencies, in ASCII or (58b) in
/// numbers of IEEE 754; with the nodes (15, 2411) and the units (164, without which values are
/// taken for SI). Directions against an axis change the sign. Other functions and datasets are left
/// out with a note.
/// @param metres  m per unit of length of the nodes; needed if there are nodes and no units (164)
/// @throws chladni::Error naming file, line and record for a violation of the format, for functions
///         at other frequencies than those of the first one, and for a file without any.
/// Source: SDRC, Universal Dataset Numbers 15, 58, 164 and 2411.
MeasuredFunctions read_measured_functions(const std::filesystem::path& path,
                                          std::optional<double> metres);

/// The functions at the frequencies of a range, which excludes none of its ends.
/// @throws chladni::Error naming the file if it has fewer than two frequencies there.
MeasuredFunctions within(const MeasuredFunctions& measured, double from_Hz, double to_Hz);

}  // namespace chladni::mbs_export
