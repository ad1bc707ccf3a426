#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace chladni::python {

/// What a file of Chladni holds, checked by the reader of its format.
/// @return the format, and (name, unit, value) of each dataset: a number, a text, a list
///         of texts, or an array of numpy
/// @throws chladni::Error when it is no such file, or is damaged.
pybind11::tuple file_values(const std::string& path);

}  // namespace chladni::python
