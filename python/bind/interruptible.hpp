#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <string>
#include <utility>

/// Long work of the libraries inside of Python.
namespace chladni::python {

/// Tells a Python function how far the work is, and looks for Ctrl-C meanwhile. What either raises
/// ends the work, whatever the libraries make of it on its way up.
class Progress {
 public:
  /// @param listener  takes the name of the phase and its part that is done, 0 to 1; or None
  explicit Progress(pybind11::object listener) : listener_(std::move(listener)) {}

  /// To be called without the lock of the interpreter, as is `tell`.
  void look_for_signals()
  {
    const pybind11::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) fail(pybind11::error_already_set());
  }

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

  /// work(), without the lock of the interpreter.
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

}  // namespace chladni::python
