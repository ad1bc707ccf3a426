// The extension module chladni._cms: the PETSc class CMS for petsc4py. Objects of PETSc come as the
// numbers that petsc4py calls handles.

#include <chladni_cms.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "common/petsc.hpp"
#include "python/bind/interruptible.hpp"

namespace chladni::python {

namespace {

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

namespace py = pybind11;

petsc::IndexSet index_set(CMS cms, const std::vector<PetscInt>& indices)
{
  petsc::IndexSet set;
  Cms::call([&] {
    return ISCreateGeneral(PetscObjectComm(reinterpret_cast<PetscObject>(cms)),
                           PetscInt(indices.size()), indices.data(), PETSC_COPY_VALUES, set.put());
  });
  return set;
}

/// The rows of this rank.
py::object own_rows(Mat A)
{
  if (A == nullptr) return py::none();
  PetscInt n_rows = 0, n_columns = 0, lda = 0;
  const PetscScalar* values = nullptr;
  Cms::call([&] { return MatGetLocalSize(A, &n_rows, nullptr); });
  Cms::call([&] { return MatGetSize(A, nullptr, &n_columns); });
  Cms::call([&] { return MatDenseGetLDA(A, &lda); });
  Cms::call([&] { return MatDenseGetArrayRead(A, &values); });
  py::array_t<double, py::array::f_style> rows({n_rows, n_columns});
  for (PetscInt j = 0; j < n_columns; ++j)
    std::copy_n(values + std::size_t(j) * lda, n_rows, rows.mutable_data(0, j));
  Cms::call([&] { return MatDenseRestoreArrayRead(A, &values); });
  return rows;
}

py::tuple reduced_operators(const Cms& cms)
{
  std::array<Mat, 3> A{};
  Cms::call([&] { return CMSGetReducedOperators(cms.get(), &A[0], &A[1], &A[2]); });
  return py::make_tuple(own_rows(A[0]), own_rows(A[1]), own_rows(A[2]));
}

py::object transformation(const Cms& cms)
{
  Mat T = nullptr;
  Cms::call([&] { return CMSGetTransformation(cms.get(), &T); });
  return own_rows(T);
}

using GetNumbers = PetscErrorCode (*)(CMS, PetscInt*, const PetscReal**);

/// Numbers of the modes that have an error estimate.
template <GetNumbers get>
py::array_t<double> numbers(const Cms& cms)
{
  PetscInt n = 0;
  const PetscReal* x = nullptr;
  Cms::call([&] { return get(cms.get(), &n, &x); });
  return py::array_t<double>(n, x);
}

py::dict count_of(const CMSCount& count)
{
  py::dict members;
  members["up_to_Hz"] = count.upto;
  members["expected"] = count.expected;
  members["found"] = count.found;
  members["missing"] = count.missing;
  return members;
}

py::dict quality(const Cms& cms)
{
  CMSQuality q{};
  Cms::call([&] { return CMSGetQuality(cms.get(), &q); });
  py::dict members;
  members["n_zero"] = q.n_zero;
  members["rigid_residual"] = q.rigid_residual;
  members["condition"] = q.condition;
  members["modes"] = count_of(q.modes);
  members["model"] = count_of(q.model);
  members["complete"] = count_of(q.complete);
  return members;
}

py::tuple dimensions(const Cms& cms)
{
  PetscInt n_masters = 0, n_modes = 0;
  Cms::call([&] { return CMSGetDimensions(cms.get(), &n_masters, &n_modes); });
  return py::make_tuple(n_masters, n_modes);
}

void set_geometry(const Cms& cms, const std::vector<PetscInt>& nodes,
                  const std::vector<PetscInt>& components, const std::vector<double>& positions)
{
  if (components.size() != nodes.size() || positions.size() != 3 * nodes.size())
    throw Error("set_interface_geometry: give a node, a component and x, y, z for each master");
  Cms::call([&] {
    return CMSSetInterfaceGeometry(cms.get(), PetscInt(nodes.size()), nodes.data(),
                                   components.data(), positions.data());
  });
}

void declare_input(py::class_<Cms>& type)
{
  type.def(py::init<HandleNumber>())
      .def("set_operators",
           [](const Cms& cms, HandleNumber K, HandleNumber M, HandleNumber C) {
             Cms::call([&] {
               return CMSSetOperators(cms.get(), object_of<Mat>(K), object_of<Mat>(M),
                                      object_of<Mat>(C));
             });
           })
      .def("set_interface",
           [](const Cms& cms, const std::vector<PetscInt>& masters) {
             const petsc::IndexSet set = index_set(cms.get(), masters);
             Cms::call([&] { return CMSSetInterface(cms.get(), set); });
           })
      .def("set_interface_geometry", &set_geometry)
      .def("set_held",
           [](const Cms& cms, const std::vector<PetscInt>& rows) {
             const petsc::IndexSet set = index_set(cms.get(), rows);
             Cms::call([&] { return CMSSetHeld(cms.get(), set); });
           })
      .def("set_output",
           [](const Cms& cms, const std::optional<std::vector<PetscInt>>& rows) {
             const petsc::IndexSet set = rows ? index_set(cms.get(), *rows) : petsc::IndexSet();
             Cms::call([&] { return CMSSetOutput(cms.get(), set); });
           })
      .def("set_options_prefix",
           [](const Cms& cms, const std::string& prefix) {
             Cms::call([&] { return CMSSetOptionsPrefix(cms.get(), prefix.c_str()); });
           })
      .def("set_from_options",
           [](const Cms& cms) { Cms::call([&] { return CMSSetFromOptions(cms.get()); }); })
      .def("reset", [](const Cms& cms) { Cms::call([&] { return CMSReset(cms.get()); }); });
}

void declare_choices(py::class_<Cms>& type)
{
  type.def("set_type",
           [](const Cms& cms, const std::string& name) {
             Cms::call([&] { return CMSSetType(cms.get(), name.c_str()); });
           })
      .def("get_type",
           [](const Cms& cms) {
             CMSType name = nullptr;
             Cms::call([&] { return CMSGetType(cms.get(), &name); });
             return std::string(name);
           })
      .def("set_dimensions",
           [](const Cms& cms, PetscInt n_modes) {
             Cms::call([&] { return CMSSetDimensions(cms.get(), n_modes); });
           })
      .def("set_cutoff",
           [](const Cms& cms, double f_Hz) {
             Cms::call([&] { return CMSSetCutoff(cms.get(), f_Hz); });
           })
      .def("set_tolerance",
           [](const Cms& cms, double tolerance, double up_to_Hz) {
             Cms::call([&] { return CMSSetTolerance(cms.get(), tolerance, up_to_Hz); });
           })
      .def("set_sylvester", [](const Cms& cms, bool count) {
        Cms::call([&] { return CMSSetSylvester(cms.get(), count ? PETSC_TRUE : PETSC_FALSE); });
      });
}

void declare_results(py::class_<Cms>& type)
{
  type.def("set_up", [](Cms& cms, py::object told) { cms.solve(std::move(told), &CMSSetUp); })
      .def("solve", [](Cms& cms, py::object told) { cms.solve(std::move(told), &CMSSolve); })
      .def("dimensions", &dimensions)
      .def("reduced_operators", &reduced_operators)
      .def("transformation", &transformation)
      .def("frequencies", &numbers<&CMSGetFrequencies>)
      .def("errors", &numbers<&CMSGetErrors>)
      .def("rounding", &numbers<&CMSGetRounding>)
      .def("error_bounds", &numbers<&CMSGetErrorBounds>)
      .def("quality", &quality)
      .def("view",
           [](const Cms& cms, HandleNumber viewer) {
             Cms::call([&] { return CMSView(cms.get(), object_of<PetscViewer>(viewer)); });
           })
      .def("write", [](const Cms& cms, const std::string& file) {
        Cms::call([&] { return CMSWrite(cms.get(), file.c_str()); });
      });
}

}  // namespace

}  // namespace chladni::python

PYBIND11_MODULE(_cms, module)
{
  namespace py = pybind11;
  py::module_::import("chladni._squeal");  // has chladni.Error
  py::class_<chladni::python::Cms> type(module, "CMS");
  chladni::python::declare_input(type);
  chladni::python::declare_choices(type);
  chladni::python::declare_results(type);
}
