// The extension module chladni._fe: from the mesh of a scene to its body, in this process.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cases/ranks.hpp"
#include "cases/reduce_scene.hpp"
#include "cases/scene_body.hpp"
#include "common/files/output_file.hpp"
#include "common/petsc.hpp"
#include "linear/solver_options.hpp"
#include "mbs_export/files/body_files.hpp"
#include "python/bind/interruptible.hpp"
#include "report/text_table.hpp"
#include "scene/scene.hpp"

namespace chladni::python {
namespace {

namespace py = pybind11;
using std::filesystem::path;

/// While it lives, failures of PETSc come back as codes and print nothing.
class SilentErrors {
 public:
  SilentErrors() { petsc::check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr)); }
  ~SilentErrors() { PetscPopErrorHandler(); }
  SilentErrors(const SilentErrors&) = delete;
  SilentErrors& operator=(const SilentErrors&) = delete;
};

/// What the reduction of a scene leaves in a folder.
struct BodyFiles {
  path reduced, body;
};

/// Writes NAME.reduced.h5 and NAME.body.h5 on the first rank, with the lock of the interpreter: no
/// other thread reads files meanwhile.
/// @return what is to be told of the body
/// @note Collective on all ranks.
std::vector<std::string> make_body(const scene::Scene& scene, const BodyFiles& files,
                                   Progress& progress)
{
  const SilentErrors silent;
  std::vector<std::shared_ptr<const files::OutputLock>> reserved;
  cases::on_first_rank([&] {
    report::make_folder(files.body.parent_path());
    for (const path& file : {files.reduced, files.body})
      reserved.push_back(files::lock_output(file));
  });
  const linear::SolverOptions options = linear::read_solver_options(PETSC_COMM_WORLD);
  const cases::ReduceSummary summary = progress.during([&] {
    return cases::reduce_scene(
        scene, {.text = "", .options = options},
        [&](const std::string& phase, double fraction) { progress.tell(phase, fraction); });
  });
  std::vector<std::string> notes;
  cases::on_first_rank([&] {
    mbs_export::write_reduced(files.reduced, summary.reduced);
    cases::SceneBody made = cases::scene_body(scene, summary.reduced);
    mbs_export::write_body(files.body, made.body);
    notes = std::move(made.notes);
  });
  return notes;
}

}  // namespace
}  // namespace chladni::python

PYBIND11_MODULE(_fe, module)
{
  namespace py = pybind11;
  using chladni::python::Progress;
  py::module_::import("chladni._squeal");  // has chladni.Error
  module.def("make_body", [](const std::string& text, const std::string& name,
                             const std::string& folder, py::object listener) {
    const chladni::scene::Scene scene = chladni::scene::parse_scene(text, name);
    const std::filesystem::path stem = std::filesystem::path(folder) / scene.name;
    Progress progress(std::move(listener));
    return chladni::python::make_body(
        scene, {.reduced = stem.string() + ".reduced.h5", .body = stem.string() + ".body.h5"},
        progress);
  });
}
