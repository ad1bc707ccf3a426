// The extension module chladni._squeal: scenes, brakes, files and pages. Without PETSc.
#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <filesystem>
#include <optional>

#include "cases/squeal/squeal_case.hpp"
#include "common/error.hpp"
#include "files/output_lock.hpp"
#include "python/bind/file_values.hpp"
#include "python/bind/interruptible.hpp"
#include "python/bind/text.hpp"
#include "report/describe.hpp"
#include "report/output.hpp"
#include "report/page/report.hpp"
#include "report/version.hpp"
#include "scene/keys.hpp"
#include "scene/scene.hpp"
#include "squeal/results/result_file.hpp"
#include "squeal/study/run.hpp"
#include "squeal/transient/wav_spool.hpp"

namespace chladni::python {
namespace {

namespace py = pybind11;
using std::filesystem::path;

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
  std::optional<squeal::WavSpool> sound;
  if (study.sound) sound.emplace(files.sound, files.spool, study.sound->rate_Hz);
  squeal::StudyKeeping keeping;
  keeping.progress = [&](const std::string& phase, double whole) { progress.tell(phase, whole); };
  keeping.sound = sound ? &*sound : nullptr;
  const squeal::SquealResults results =
      progress.during([&] { return squeal::run(*brake_case.brake, study, keeping); });
  squeal::write_results(files.results, results, origin.provenance);
  if (sound) sound->remove();
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
