#pragma once

#include <string>
#include <vector>

#include "common/files/hdf5.hpp"

/// Checks of values in a result file when they are read, so that later code can use them as
/// indices.
namespace chladni::squeal {

/// Reads distinct 1-based mode numbers of a body.
/// @throws chladni::Error naming the dataset when the values are not such numbers.
std::vector<int> read_mode_numbers(const files::Reader& file, const std::string& name);

/// Reads times (s) that do not decrease.
/// @param size  required number of times
/// @throws chladni::Error naming the dataset when the values are not such times.
std::vector<double> read_times(const files::Reader& file, const std::string& name,
                               Eigen::Index size = files::any);

/// Reads values of which there is at least one.
/// @throws chladni::Error naming the dataset when it is empty.
Eigen::VectorXd read_some(const files::Reader& file, const std::string& name);

}  // namespace chladni::squeal
