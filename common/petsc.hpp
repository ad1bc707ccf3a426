#pragma once

#include <fmt/format.h>
#include <petscmat.h>
#include <slepceps.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "common/error.hpp"

static_assert(!PetscDefined(USE_COMPLEX), "Chladni needs the real build of PETSc");
static_assert(PetscDefined(USE_REAL_DOUBLE), "Chladni needs the double-precision build of PETSc");

/// Owned PETSc objects and the bridge from PETSc's error codes to chladni::Error.
namespace chladni::petsc {

/// Thrown when a PETSc call failed; PETSc has already reported the reason.
class Failure : public Error {
 public:
  Failure(PetscErrorCode error_code, const std::string& text) : Error(text), code(error_code) {}
  PetscErrorCode code;
};

/// True if a PETSc call failed for lack of memory. PETSc 3.18 then returns the line of the failed
/// malloc as the code, and the name of its function as the text.
inline bool is_out_of_memory(PetscErrorCode code, const char* text)
{
  const bool is_a_name = text != nullptr && std::strchr(text, ' ') == nullptr;
  return code == PETSC_ERR_MEM || (errno == ENOMEM && is_a_name);
}

/// PETSc's texts of an error: the general one and the specific one, whose type differs from PETSc
/// 3.25 on.
template <class Specific>
struct ErrorTexts {
  const char* text = nullptr;
  Specific* specific = nullptr;
};

template <class Specific>
ErrorTexts<Specific> error_texts(PetscErrorCode (*ask)(PetscErrorCode, const char**, Specific**),
                                 PetscErrorCode code)
{
  ErrorTexts<Specific> texts;
  ask(code, &texts.text, &texts.specific);
  return texts;
}

/// Checks the return code of a PETSc call.
/// @throws Failure with PETSc's own text when the call failed.
inline void check(PetscErrorCode code)
{
  if (code == 0) return;
  const auto [text, specific] = error_texts(PetscErrorMessage, code);
  if (is_out_of_memory(code, specific)) {
    throw Failure(PETSC_ERR_MEM,
                  fmt::format("out of memory ({}); use more machines, a coarser mesh or fewer "
                              "modes, or raise the limit of this shell (ulimit -v)",
                              specific ? specific : "PETSc"));
  }
  throw Failure(code, fmt::format("PETSc error {}: {} {}", static_cast<int>(code), text ? text : "",
                                  specific ? specific : ""));
}

/// Move-only owner of a PETSc object; destroyed before PetscFinalize by scope.
template <typename Object, PetscErrorCode (*destroy)(Object*)>
class Owned {
 public:
  Owned() = default;
  explicit Owned(Object object) : object_(object) {}
  Owned(Owned&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Owned& operator=(Owned&& other) noexcept
  {
    std::swap(object_, other.object_);
    return *this;
  }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned()
  {
    if (object_) destroy(&object_);
  }

  operator Object() const { return object_; }  // NOLINT(google-explicit-constructor): as PETSc's

  /// The address for a PETSc function that creates an object; for empty handles only.
  Object* put() { return &object_; }

 private:
  Object object_ = nullptr;
};

using Matrix = Owned<Mat, MatDestroy>;
using Vector = Owned<Vec, VecDestroy>;
using IndexSet = Owned<IS, ISDestroy>;
using LinearSolver = Owned<KSP, KSPDestroy>;
using EigenSolver = Owned<EPS, EPSDestroy>;

/// The communicator of a PETSc object.
template <typename Object>
MPI_Comm communicator(Object object)
{
  MPI_Comm comm = MPI_COMM_NULL;
  check(PetscObjectGetComm(reinterpret_cast<PetscObject>(object), &comm));
  return comm;
}

template <typename Object, PetscErrorCode (*destroy)(Object*)>
MPI_Comm communicator(const Owned<Object, destroy>& owned)
{
  return communicator(static_cast<Object>(owned));
}

inline int rank(MPI_Comm comm)
{
  int r = 0;
  MPI_Comm_rank(comm, &r);
  return r;
}

inline int size(MPI_Comm comm)
{
  int n = 1;
  MPI_Comm_size(comm, &n);
  return n;
}

}  // namespace chladni::petsc
