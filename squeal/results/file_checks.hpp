#pragma once

#include <string>
#include <vector>

#include "files/hdf5.hpp"

/// What a result file may say, checked where it is read, so that whoever indexes with it later need
/// not doubt it.
namespace chladni::squeal {

/// Numbers of modes of a body, from 1; each one once.
/// @throws chladni::Error naming the dataset otherwise.
std::vector<int> read_mode_numbers(const files::Reader& file, const std::string& name);

/// Times that do not fall, s.
/// @param size  how many there must be
/// @throws chladni::Error naming the dataset otherwise.
std::vector<double> read_times(const files::Reader& file, const std::string& name,
                               Eigen::Index size = files::any);

/// Values of which there is one at least.
/// @throws chladni::Error naming the dataset otherwise.
Eigen::VectorXd read_some(const files::Reader& file, const std::string& name);

}  // namespace chladni::squeal
