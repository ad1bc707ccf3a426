#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cases/export_limits.hpp"
#include "cases/ranks.hpp"
#include "cases/squeal/brake_fmu.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "common/error.hpp"
#include "common/files/output_file.hpp"
#include "mbs_export/body_options.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mbs_export/formats/export_error.hpp"
#include "mbs_export/formats/fmu_archive.hpp"
#include "mbs_export/formats/formats.hpp"
#include "report/origin.hpp"
#include "scene/scene.hpp"

namespace chladni::cli {
namespace {

namespace formats = mbs_export::formats;
using std::filesystem::path;

/// The scene's supports and modes, or only a file: a reduced system, or a body for `mat`.
struct Source {
  std::optional<scene::Scene> scene;
  path reduced_file;
  path stem;  ///< of the written file, when no name is given
};

Source source_of(const ExportArguments& arguments)
{
  const path given = arguments.source;
  if (given.extension() == ".h5") {
    path stem = given.filename();
    while (stem.has_extension()) stem.replace_extension();
    return {.scene = std::nullopt, .reduced_file = given, .stem = stem};
  }
  scene::Scene scene = scene::read_meshed_scene(given);
  const path file = path(arguments.from) / (scene.name + ".reduced.h5");
  if (!std::filesystem::exists(file)) {
    throw Error(fmt::format("{}: no such file; make it with `chladni reduce {} --output {}`",
                            file.string(), arguments.source, arguments.from));
  }
  path stem = scene.name;
  return {.scene = std::move(scene), .reduced_file = file, .stem = stem};
}

/// Of the scene as it is, where that is given.
mbs_export::ReducedSystem read_reduced_of(const ExportArguments& arguments, const Source& source)
{
  mbs_export::ReducedSystem reduced = mbs_export::read_reduced(source.reduced_file);
  if (source.scene) {
    report::require_of_scene(*source.scene,
                             {.file = source.reduced_file,
                              .what = report::Made::reduction,
                              .origin = reduced.provenance},
                             arguments.stale ? report::Stale::use : report::Stale::refuse);
  }
  return reduced;
}

/// The file to write: as asked for, or NAME with the extension of the format.
path target_of(const ExportArguments& arguments, const Source& source, const std::string& extension)
{
  return arguments.output.empty() ? path(source.stem.string() + extension) : path(arguments.output);
}

std::string write(const path& file, const std::string& text)
{
  files::write_text(file, text);
  return file.string();
}

std::vector<std::string> export_superelement(const ExportArguments& arguments, const Source& source,
                                             const mbs_export::ReducedSystem& reduced)
{
  path file = target_of(arguments, source, ".op4");
  const auto files = formats::nastran_superelement(reduced, arguments.superelement);
  return {write(file, files.op4), write(file.replace_extension(".asm"), files.assembly),
          write(file.replace_extension(".pch"), files.superelement)};
}

formats::FloatingBody floating_body_of(const ExportArguments& arguments, const Source& source,
                                       const mbs_export::ReducedSystem& reduced)
{
  if (!source.scene) {
    throw Error(fmt::format("{}: {} needs the supports and modes of [body]; give the scene",
                            arguments.source, arguments.format));
  }
  return formats::floating_body(reduced, source.scene->body);
}

/// The files written, and what is not in them.
struct Exported {
  std::vector<std::string> files;
  std::vector<std::string> notes;
};

formats::SidOptions sid_options(const ExportArguments& arguments)
{
  return {.dialect = arguments.sid_dialect == "welib" ? formats::SidDialect::welib
                                                      : formats::SidDialect::simpack,
          .gyroscopic = arguments.sid_gyroscopic == "by-axis" ? formats::SidGyroscopic::by_axis
                                                              : formats::SidGyroscopic::by_mode};
}

/// A body in a frame that moves with it.
std::string export_floating_body(const ExportArguments& arguments, const Source& source,
                                 const formats::FloatingBody& floating)
{
  if (arguments.format == "exudyn") {
    const path file = target_of(arguments, source, ".exudyn.hdf5");
    formats::write_exudyn(file, floating);
    return file.string();
  }
  if (arguments.format == "sid") {
    return write(target_of(arguments, source, ".SID_FEM"),
                 formats::sid_fem(floating, sid_options(arguments)));
  }
  const auto version =
      arguments.format == "mbdyn" ? formats::MbdynVersion::v1_7 : formats::MbdynVersion::develop;
  return write(target_of(arguments, source, ".fem"), formats::mbdyn_fem(floating, version));
}

std::vector<std::string> export_matrices(const ExportArguments& arguments, const Source& source,
                                         const mbs_export::ReducedSystem& reduced)
{
  const auto texts = formats::matrix_market(reduced);
  path named = target_of(arguments, source, "");
  if (named.extension() == ".mtx") named.replace_extension();
  const std::string stem = named.string();
  std::vector<std::string> files{write(stem + ".K.mtx", texts.K), write(stem + ".M.mtx", texts.M)};
  if (!texts.C.empty()) files.push_back(write(stem + ".C.mtx", texts.C));
  if (!texts.H.empty()) files.push_back(write(stem + ".H.mtx", texts.H));
  files.push_back(write(stem + ".coordinates.csv", texts.coordinates));
  return files;
}

/// A reduced system, of which [body] is no part.
Exported export_reduced(const ExportArguments& arguments, const Source& source,
                        const mbs_export::ReducedSystem& reduced)
{
  const mbs_export::Damping damping =
      source.scene ? source.scene->body.damping : mbs_export::Damping{};
  std::vector<std::string> notes =
      cases::with_stiffening_left_out(cases::damping_left_out(arguments.format, damping, 0),
                                      arguments.format, reduced.stiffening, {});
  if (reduced.H.size() > 0 && arguments.format != "matrix-market") {
    notes.emplace_back(
        "the structural damping (loss factors) is left out: this file holds K, M and the dampers; "
        "--format matrix-market writes it");
  }
  if (arguments.format == "nastran-op4")
    return {export_superelement(arguments, source, reduced), std::move(notes)};
  if (arguments.format == "matrix-market")
    return {export_matrices(arguments, source, reduced), std::move(notes)};
  const path file = target_of(arguments, source, ".dmig");
  return {{write(file, formats::nastran_dmig(reduced))}, std::move(notes)};
}

/// The body in the file, or that of the scene as it is.
mbs_export::ModalBody body_to_export(const ExportArguments& arguments, const Source& source)
{
  if (!source.scene) {
    mbs_export::ModalBody body = mbs_export::read_body(source.reduced_file);
    cases::refuse_condensed(body, source.reduced_file.string());
    return body;
  }
  return make_body_of(*source.scene, read_reduced_of(arguments, source));
}

formats::FmiVersion fmi_version(const ExportArguments& arguments)
{
  return arguments.fmi == "3" ? formats::FmiVersion::v3 : formats::FmiVersion::v2;
}

Exported export_fmu(const ExportArguments& arguments, const Source& source)
{
  const path file = target_of(arguments, source, ".fmu");
  const mbs_export::ModalBody body = body_to_export(arguments, source);
  const auto made =
      formats::fmu(body, {.version = fmi_version(arguments),
                          .sets = arguments.nodes,
                          .identifier = formats::fmu_identifier(file.stem().string())});
  return {{write(file, made.archive)},
          cases::with_stiffening_left_out(made.notes, arguments.format, body.stiffening,
                                          body.stiffening)};
}

/// The brake of a scene with the body beside the reduced system.
Exported export_brake_fmu(const ExportArguments& arguments)
{
  if (path(arguments.source).extension() == ".h5") {
    throw Error(
        fmt::format("{}: an FMU of a brake is made of its scene, whose [squeal] says what "
                    "holds the disc",
                    arguments.source));
  }
  const scene::Scene scene = scene::read_scene(arguments.source);
  const path file = arguments.output.empty() ? path(scene.name + ".fmu") : path(arguments.output);
  const auto made = cases::fmu_of_brake(
      scene, {.version = fmi_version(arguments),
              .identifier = formats::fmu_identifier(file.stem().string()),
              .folder = arguments.from,
              .stale = arguments.stale ? report::Stale::use : report::Stale::refuse});
  return {{write(file, made.archive)}, made.notes};
}

Exported export_as(const ExportArguments& arguments, const Source& source)
{
  if (arguments.format == "fmu") return export_fmu(arguments, source);
  const mbs_export::ReducedSystem reduced = read_reduced_of(arguments, source);
  const bool is_of_reduced =
      arguments.format == "matrix-market" || arguments.format.starts_with("nastran");
  if (is_of_reduced) return export_reduced(arguments, source, reduced);
  const formats::FloatingBody floating = floating_body_of(arguments, source, reduced);
  return {{export_floating_body(arguments, source, floating)},
          cases::with_stiffening_left_out(
              cases::damping_left_out(arguments.format, source.scene->body.damping,
                                      floating.body.n_free_rigid),
              arguments.format, reduced.stiffening, floating.body.stiffening)};
}

/// What the scene asks for in vain is told with its place there.
Exported export_of(const ExportArguments& arguments)
{
  if (arguments.format == "fmu-brake") return export_brake_fmu(arguments);
  const Source source = source_of(arguments);
  try {
    return export_as(arguments, source);
  } catch (const mbs_export::BodyOptionError& error) {
    scene::refuse_key(*source.scene, "body." + error.key(), error.why());
  } catch (const formats::ExportError& error) {
    if (source.scene) cases::refuse_export(*source.scene, error);
    throw Error(fmt::format("{}: {}", arguments.source, error.why()));
  }
}

void export_and_report(const ExportArguments& arguments)
{
  const auto [files, notes] = export_of(arguments);
  for (const std::string& file : files) fmt::print("wrote {}\n", file);
  for (const std::string& note : notes) fmt::print("note: {}\n", note);
  write_summary({.scene = arguments.source, .output = {}, .json = arguments.json},
                {{"source", arguments.source},
                 {"format", arguments.format},
                 {"files", report::Json::array({files.begin(), files.end()})},
                 {"notes", report::Json::array({notes.begin(), notes.end()})}},
                report::cost_so_far({}));
}

}  // namespace

const std::vector<std::string>& export_formats()
{
  static const std::vector<std::string> names{"nastran-dmig", "nastran-op4",   "matrix-market",
                                              "mbdyn",        "mbdyn-develop", "sid",
                                              "exudyn",       "fmu",           "fmu-brake"};
  return names;
}

const std::vector<std::string>& sid_dialects()
{
  static const std::vector<std::string> names{"simpack", "welib"};
  return names;
}

const std::vector<std::string>& sid_gyroscopic_orders()
{
  static const std::vector<std::string> names{"by-mode", "by-axis"};
  return names;
}

const std::vector<std::string>& fmi_versions()
{
  static const std::vector<std::string> versions{"2", "3"};
  return versions;
}

void export_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { export_and_report(arguments.exported); });
}

}  // namespace chladni::cli
