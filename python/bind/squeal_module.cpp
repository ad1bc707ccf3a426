// The extension module chladni._squeal: scenes, brakes, files and pages. Without PETSc.

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

#include "cases/squeal/squeal_case.hpp"
#include "common/error.hpp"
#include "common/files/hdf5.hpp"
#include "common/files/output_file.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mbs_export/responses/response_files.hpp"
#include "python/bind/interruptible.hpp"
#include "report/describe_body.hpp"
#include "report/page/pages.hpp"
#include "report/text_table.hpp"
#include "report/timing.hpp"
#include "report/version.hpp"
#include "scene/keys.hpp"
#include "scene/scene.hpp"
#include "squeal/brake/radiation.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/study/study.hpp"
#include "squeal/transient/wav.hpp"

namespace chladni::python {

using files::Item;
using std::filesystem::path;

namespace {

namespace py = pybind11;

/// [rows x cols] as numpy stores it.
template <class Matrix>
py::array_t<typename Matrix::Scalar> by_rows(const Matrix& A)
{
  py::array_t<typename Matrix::Scalar> array({A.rows(), A.cols()});
  auto entries = array.template mutable_unchecked<2>();
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < A.cols(); ++j) entries(i, j) = A(i, j);
  return array;
}

py::object reals(const files::Reader& file, const Item& item)
{
  if (item.rank == 0) return py::float_(file.real(item.name));
  if (item.rank == 2) return by_rows(file.matrix(item.name));
  const Eigen::VectorXd x = file.vector(item.name);
  return py::array_t<double>(x.size(), x.data());
}

py::object integers(const files::Reader& file, const Item& item)
{
  if (item.rank == 0) return py::int_(file.integer(item.name));
  if (item.rank == 2) return by_rows(file.integer_matrix(item.name));
  const std::vector<std::int64_t> x = file.integers(item.name);
  return py::array_t<std::int64_t>(py::ssize_t(x.size()), x.data());
}

py::object texts(const files::Reader& file, const Item& item)
{
  py::list list;
  for (const std::string& text : file.texts(item.name)) list.append(text_of(text));
  return list;
}

py::object value_of(const files::Reader& file, const Item& item)
{
  switch (item.kind) {
    case Item::Kind::reals:
      return reals(file, item);
    case Item::Kind::integers:
      return integers(file, item);
    default:
      return item.rank == 0 ? py::object(text_of(file.text(item.name))) : texts(file, item);
  }
}

/// The reader of the format checks what its values say of each other.
void check(const files::Reader& file, const std::string& format)
{
  if (format == mbs_export::body_format)
    mbs_export::read_body(file);
  else if (format == mbs_export::reduced_format)
    mbs_export::read_reduced(file);
  else if (format == mbs_export::response_format)
    mbs_export::read_responses(file);
  else if (format == squeal::results_format)
    squeal::read_results(file);
  else if (format == "chladni-radiation")
    squeal::read_radiation(file);
  else if (format != "chladni-sound")
    file.fail("/", fmt::format("has format '{}', which is none of Chladni's", format));
}

bool is_of_vtk(const Item& item)
{
  return item.name.starts_with("VTKHDF/");
}

/// The contents of a file of Chladni, checked by the reader of its format.
/// @return the format, and (name, unit, value) of each dataset: a number, a text, a list of texts,
///         or a numpy array
/// @throws chladni::Error when the file is not one of Chladni's or is damaged.
py::tuple file_values(const std::string& path)
{
  const files::Reader file(path);
  const std::string format = file.text_attribute("/", "format");
  check(file, format);
  py::list values;
  for (const Item& item : files::contents(file))
    if (!is_of_vtk(item))
      values.append(py::make_tuple(text_of(item.name), text_of(item.unit), value_of(file, item)));
  return py::make_tuple(text_of(format), values);
}

/// What a run in Python takes beside its scene.
struct SquealRun {
  path folder;
  path body;  ///< empty for that of the scene in the folder
};

/// Performs the analyses of [squeal] and writes NAME.squeal.h5. The lock of the interpreter is free
/// during the analyses alone: a file that is read is tried in a forked process first, and there
/// libhdf5 would wait for ever for what another thread was doing.
/// @return what is to be told of the brake
std::vector<std::string> run_squeal(const scene::Scene& scene, const SquealRun& run,
                                    Progress& progress)
{
  cases::require_study(scene);
  report::make_folder(run.folder);
  const cases::SquealFiles files = cases::squeal_files(scene, run.folder, run.body);
  cases::StaleChoice stale;
  if (run.body.empty()) stale = report::Stale::refuse;
  const auto body = cases::body_for_squeal(scene, files, stale);
  const auto reserved = files::lock_output(files.results);
  const cases::SquealCase brake_case = cases::squeal_case(scene, body, files, stale);
  const squeal::RunOrigin origin = cases::squeal_origin(scene, body, files, "");
  const squeal::StudyOptions& study = cases::study_of(scene);
  std::optional<squeal::WavRecording> sound;
  if (study.sound) sound.emplace(files.sound, study.sound->rate_Hz);
  squeal::StudyKeeping keeping;
  keeping.progress = [&](const std::string& phase, double whole) { progress.tell(phase, whole); };
  keeping.sound = sound ? &*sound : nullptr;
  const squeal::SquealResults results =
      progress.during([&] { return squeal::run(*brake_case.brake, study, keeping); });
  squeal::write_results(files.results, results, origin.provenance);
  return brake_case.notes;
}

/// chladni::Error as the exception `Error`, in this module and in those that come after it.
void declare_error(py::module_& module)
{
  static py::handle type = py::exception<Error>(module, "Error", PyExc_RuntimeError).release();
  // NOLINTNEXTLINE(performance-unnecessary-value-param): as pybind11 wants it
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      PyErr_SetObject(type.ptr(), text_of(error.what()).ptr());
    }
  });
}

void declare_scene(py::module_& module)
{
  using scene::Scene;
  py::class_<Scene>(module, "Scene")
      .def_static("parse", [](const std::string& text,
                              const std::string& path) { return scene::parse_scene(text, path); })
      .def_static("read", [](const std::string& path) { return scene::read_scene(path); })
      .def_readonly("name", &Scene::name)
      .def_readonly("title", &Scene::title)
      .def_readonly("text", &Scene::text)
      .def_readonly("path", &Scene::path)
      .def_readonly("notes", &Scene::notes)
      .def_property_readonly("has_squeal",
                             [](const Scene& scene) { return scene.squeal || scene.squeal_model; })
      .def_property_readonly("needs_body", [](const Scene& scene) { return !scene.squeal_model; });
}

void declare_functions(py::module_& module)
{
  module.def("run_squeal", [](const scene::Scene& scene, const std::string& folder,
                              const std::string& body, py::object listener) {
    report::keep_freed_memory();
    Progress progress(std::move(listener));
    return run_squeal(scene, {.folder = folder, .body = body}, progress);
  });
  module.def("file_values", &file_values);
  module.def("describe",
             [](const std::string& file) { return text_of(report::describe_file(file)); });
  module.def("report_html", [](const scene::Scene& scene, const std::string& folder) {
    return text_of(report::report_html({.scene = scene, .folder = folder}, "null"));
  });
  module.def("scene_reference", &scene::scene_reference);
}

}  // namespace

}  // namespace chladni::python

PYBIND11_MODULE(_squeal, module)
{
  namespace py = pybind11;
  chladni::python::declare_error(module);
  module.attr("version") = std::string(chladni::report::version);
  chladni::python::declare_scene(module);
  chladni::python::declare_functions(module);
}
