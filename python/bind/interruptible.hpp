#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <string>
#include <string_view>
#include <utility>

/// Long computations of the libraries inside Python.

namespace chladni::python {

/// Reports the progress of a computation to a Python function and checks for Ctrl-C. An exception
/// raised by either ends the computation and is raised again in Python, even if the libraries
/// convert it on the way.
class Progress {
 public:
  /// @param listener  called with the name of the phase and the fraction done, 0 to 1; or None
  explicit Progress(pybind11::object listener) : listener_(std::move(listener)) {}

  /// Checks for Ctrl-C. Call it without the interpreter lock, as `tell`.
  void look_for_signals()
  {
    const pybind11::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) fail(pybind11::error_already_set());
  }

  /// Checks for Ctrl-C, then calls the listener. Call it without the interpreter lock.
  void tell(const std::string& phase, double fraction)
  {
    look_for_signals();
    const pybind11::gil_scoped_acquire locked;
    if (listener_.is_none()) return;
    try {
      listener_(phase, fraction);
    } catch (const pybind11::error_already_set& error) {
      fail(error);
    }
  }

  /// Returns work(), run without the interpreter lock.
  /// @throws what a signal or the listener raised, else what `work` threw.
  template <class Work>
  auto during(const Work& work)
  {
    try {
      const pybind11::gil_scoped_release unlocked;
      return work();
    } catch (...) {
      if (raised_) std::rethrow_exception(raised_);
      throw;
    }
  }

 private:
  [[noreturn]] void fail(const pybind11::error_already_set& error)
  {
    raised_ = std::make_exception_ptr(error);
    throw error;
  }

  pybind11::object listener_;
  std::exception_ptr raised_;
};

/// The text as a Python str; bytes that are not UTF-8, as in damaged files, become U+FFFD.
inline pybind11::str text_of(std::string_view text)
{
  PyObject* const decoded =
      PyUnicode_DecodeUTF8(text.data(), pybind11::ssize_t(text.size()), "replace");
  if (decoded == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::str>(decoded);
}

}  // namespace chladni::python
