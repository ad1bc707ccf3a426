#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "mbs_export/measured/record_reader.hpp"
#include "mbs_export/responses/response_options.hpp"

namespace chladni::mbs_export {

/// A node and a direction: 1 to 6 for x, y, z and rotations about them, negative against the axis,
/// 0 for a scalar.
struct UniversalDof {
  std::int64_t node;
  int direction;
};

/// A function of a universal file (dataset 58) with the values that the file has.
struct Function58 {
  std::size_t line = 0;  ///< of the file
  std::string why_not;   ///< what it is where it is no response to a force; the rest is empty then
  std::string name;      ///< first line of text
  UniversalDof output = {}, load = {};
  std::optional<ResponseQuantity> quantity = {};
  std::string unit_of_output, unit_of_load;  ///< words at the axes
  Eigen::VectorXd f_Hz;                      ///< [n_f] ascending
  Eigen::VectorXcd H;                        ///< [n_f]
};

/// Reads a dataset 58, in ASCII or binary.
/// @throws chladni::Error naming file, line and record for a violation of the format.
/// Source: SDRC, Universal Dataset Number 58 (30 June 1999).
Function58 read_function_58(RecordReader& records, const UniversalDataset& dataset);

}  // namespace chladni::mbs_export
