#pragma once

#include "files/hdf5.hpp"
#include "squeal/results/gradient_results.hpp"

/// Writes the group /gradients of a result file.
namespace chladni::squeal {

void write_gradients(files::Writer& file, const Gradients& gradients);

/// Reads the group /gradients of a result file.
/// @throws chladni::Error when the group is damaged.
Gradients read_gradients(const files::Reader& file);

}  // namespace chladni::squeal
