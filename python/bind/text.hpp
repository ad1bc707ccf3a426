#pragma once

#include <pybind11/pybind11.h>

#include <string_view>

namespace chladni::python {

/// The text as a Python str; bytes that are not UTF-8, as in damaged files, become U+FFFD.
inline pybind11::str text_of(std::string_view text)
{
  PyObject* const decoded =
      PyUnicode_DecodeUTF8(text.data(), pybind11::ssize_t(text.size()), "replace");
  if (decoded == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::str>(decoded);
}

}  // namespace chladni::python
