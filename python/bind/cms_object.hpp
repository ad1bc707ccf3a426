#pragma once

#include <chladni_cms.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <new>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "python/bind/interruptible.hpp"

namespace chladni::python {

/// Address of a PETSc object, as petsc4py passes handles.
using HandleNumber = std::uintptr_t;

/// The PETSc object at that address.
template <class Object>
Object object_of(HandleNumber handle)
{
  return reinterpret_cast<Object>(handle);  // NOLINT(performance-no-int-to-ptr): it is one
}

/// While an object of this class exists, PETSc errors are kept as text and not printed.
class CollectedErrors {
 public:
  CollectedErrors() { PetscPushErrorHandler(&collect, this); }
  ~CollectedErrors() { PetscPopErrorHandler(); }
  CollectedErrors(const CollectedErrors&) = delete;
  CollectedErrors& operator=(const CollectedErrors&) = delete;

  /// Throws when `code` is an error.
  /// @throws chladni::Error with the text of the first error, std::bad_alloc when PETSc ran out of
  ///         memory.
  void check(PetscErrorCode code) const
  {
    if (code == 0) return;
    if (code == PETSC_ERR_MEM) throw std::bad_alloc();
    const char* general = nullptr;
    if (text_.empty()) PetscErrorMessage(code, &general, nullptr);
    throw Error(general != nullptr ? general : text_);
  }

 private:
  static PetscErrorCode collect(MPI_Comm /*comm*/, int /*line*/, const char* /*function*/,
                                const char* /*file*/, PetscErrorCode code, PetscErrorType type,
                                const char* text, void* errors)
  {
    auto& kept = static_cast<CollectedErrors*>(errors)->text_;
    if (type == PETSC_ERROR_INITIAL && text != nullptr) kept = text;
    return code;
  }

  std::string text_;
};

/// Owner of a CMS, which can report its phases to a Python function.
class Cms {
 public:
  /// Creates the CMS on the communicator of another PETSc object.
  explicit Cms(HandleNumber of_same_comm)
  {
    call([&] { return CMSCreate(PetscObjectComm(object_of<PetscObject>(of_same_comm)), &cms_); });
  }
  /// Destroys the CMS unless PETSc has already been finalised, as it is when the interpreter exits.
  ~Cms()
  {
    PetscBool is_over = PETSC_FALSE;
    PetscFinalized(&is_over);
    if (!is_over) CMSDestroy(&cms_);
  }
  Cms(const Cms&) = delete;
  Cms& operator=(const Cms&) = delete;

  CMS get() const { return cms_; }

  /// Calls function() and turns a PETSc error into an exception.
  /// @throws chladni::Error when the function returns an error.
  template <class Function>
  static void call(const Function& function)
  {
    const CollectedErrors errors;
    errors.check(function());
  }

  /// Calls function(cms) without the interpreter lock, with progress reported to `listener`.
  /// @throws what the listener or Ctrl-C raised, else chladni::Error.
  void solve(pybind11::object listener, PetscErrorCode (*function)(CMS))
  {
    Progress progress(std::move(listener));
    const auto forget = [&] {
      CMSMonitorSet(cms_, nullptr, nullptr);
      CMSProgressSet(cms_, nullptr, nullptr);
    };
    try {
      progress.during([&] {
        call([&] { return CMSMonitorSet(cms_, &tell, &progress); });
        call([&] { return CMSProgressSet(cms_, &look_for_signals, &progress); });
        call([&] { return function(cms_); });
      });
    } catch (...) {
      forget();
      throw;
    }
    forget();
  }

 private:
  static PetscErrorCode tell(CMS /*cms*/, const char phase[], PetscReal seconds, void* progress)
  {
    try {
      static_cast<Progress*>(progress)->tell(phase, seconds);
      return 0;
    } catch (...) {  // Progress keeps it
      return PETSC_ERR_USER;
    }
  }
  static PetscErrorCode look_for_signals(CMS /*cms*/, const char[] /*phase*/,
                                         PetscReal /*fraction*/, void* progress)
  {
    try {
      static_cast<Progress*>(progress)->look_for_signals();
      return 0;
    } catch (...) {
      return PETSC_ERR_USER;
    }
  }

  CMS cms_ = nullptr;
};

}  // namespace chladni::python
