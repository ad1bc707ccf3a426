#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace chladni::python {

/// The contents of a file of Chladni, checked by the reader of its format.
/// @return the format, and (name, unit, value) of each dataset: a number, a text, a list of texts,
///         or a numpy array
/// @throws chladni::Error when the file is not one of Chladni's or is damaged.
pybind11::tuple file_values(const std::string& path);

}  // namespace chladni::python
