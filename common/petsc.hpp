#pragma once

#include <fmt/format.h>
#include <petscmat.h>
#include <petscsys.h>
#include <slepceps.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

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

/// Differences between the versions of PETSc and SLEPc from 3.18 on.

namespace chladni::petsc {

/// The value of a number that PETSc is to choose.
#if PETSC_VERSION_LT(3, 22, 0)
inline constexpr int automatic = PETSC_DEFAULT;
#else
inline constexpr int automatic = PETSC_DETERMINE;
#endif

/// The type of the argument from which an object's function reads its options.
#if PETSC_VERSION_LT(3, 23, 0)
using OptionItems = PetscOptionItems*;
#else
using OptionItems = PetscOptionItems;
#endif

}  // namespace chladni::petsc

#if PETSC_VERSION_LT(3, 20, 0)
#define PetscAssertPointer PetscValidPointer  // NOLINT(readability-identifier-naming)
#endif

namespace chladni::petsc {

/// Keeps something as long as a PETSc object lives, such as the arrays of a matrix that refers to
/// them.
/// @param name  of what is kept, one for each kind; replaces what was kept by this name
template <typename T>
void keep_with(PetscObject object, const char* name, std::unique_ptr<T> kept)
{
  PetscContainer container = nullptr;
  check(PetscContainerCreate(PetscObjectComm(object), &container));
  check(PetscContainerSetPointer(container, kept.release()));
  check(PetscContainerSetUserDestroy(container, [](void* attached) -> PetscErrorCode {
    delete static_cast<T*>(attached);
    return 0;
  }));
  check(PetscObjectCompose(object, name, reinterpret_cast<PetscObject>(container)));
  check(PetscContainerDestroy(&container));  // the object keeps it
}

/// What `keep_with` keeps by a name, or null.
template <typename T>
T* kept_with(PetscObject object, const char* name)
{
  PetscContainer container = nullptr;
  void* kept = nullptr;
  check(PetscObjectQuery(object, name, reinterpret_cast<PetscObject*>(&container)));
  if (container != nullptr) check(PetscContainerGetPointer(container, &kept));
  return static_cast<T*>(kept);
}

/// The global indices of a set that this rank holds.
inline std::vector<PetscInt> own_indices(IS set)
{
  PetscInt n = 0;
  const PetscInt* indices = nullptr;
  check(ISGetLocalSize(set, &n));
  check(ISGetIndices(set, &indices));
  std::vector<PetscInt> own(indices, indices + n);
  check(ISRestoreIndices(set, &indices));
  return own;
}

/// Those of rows of A, on the rank that owns them, counted from its first row.
inline std::vector<PetscInt> own_rows(IS rows, Mat A)
{
  PetscInt first = 0;
  check(MatGetOwnershipRange(A, &first, nullptr));
  std::vector<PetscInt> own = own_indices(rows);
  for (PetscInt& row : own) row -= first;
  return own;
}

/// How many indices of a set the ranks before this one hold.
/// @note   Collective on the communicator of the set.
inline PetscInt indices_before(IS set)
{
  PetscInt n = 0, before = 0;
  check(ISGetLocalSize(set, &n));
  MPI_Exscan(&n, &before, 1, MPIU_INT, MPI_SUM, communicator(set));
  return rank(communicator(set)) == 0 ? 0 : before;
}

}  // namespace chladni::petsc
