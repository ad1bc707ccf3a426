#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "common/error.hpp"
#include "files/text_file.hpp"
#include "mbs_export/files/reduced_file.hpp"
#include "mbs_export/formats/exudyn.hpp"
#include "mbs_export/formats/mbdyn.hpp"
#include "mbs_export/formats/nastran.hpp"
#include "mbs_export/formats/sid.hpp"
#include "scene/scene.hpp"

namespace chladni::cli {
namespace {

namespace formats = mbs_export::formats;
using std::filesystem::path;

/// The scene's supports and modes, or only a reduced file.
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
  if (!std::filesystem::exists(file))
    throw Error(fmt::format("{}: no such file; make it with `chladni reduce {} --output {}`",
                            file.string(), arguments.source, arguments.from));
  path stem = scene.name;
  return {.scene = std::move(scene), .reduced_file = file, .stem = stem};
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
  const auto files = mbs_export::formats::nastran_superelement(reduced, arguments.superelement);
  return {write(file, files.op4), write(file.replace_extension(".asm"), files.assembly),
          write(file.replace_extension(".pch"), files.superelement)};
}

mbs_export::formats::FloatingBody floating_body_of(const ExportArguments& arguments,
                                                   const Source& source,
                                                   const mbs_export::ReducedSystem& reduced)
{
  if (!source.scene)
    throw Error(fmt::format("{}: {} needs the supports and modes of [body]; give the scene",
                            arguments.source, arguments.format));
  return mbs_export::formats::floating_body(reduced, source.scene->body);
}

formats::SidOptions sid_options(const ExportArguments& arguments)
{
  return {.dialect = arguments.sid_dialect == "welib" ? formats::SidDialect::welib
                                                      : formats::SidDialect::simpack,
          .gyroscopic = arguments.sid_gyroscopic == "by-axis" ? formats::SidGyroscopic::by_axis
                                                              : formats::SidGyroscopic::by_mode};
}

/// A body in a frame that moves with it.
std::string export_floating_body(const ExportArguments& arguments, const Source& source,
                                 const mbs_export::formats::FloatingBody& floating)
{
  if (arguments.format == "exudyn") {
    const path file = target_of(arguments, source, ".exudyn.hdf5");
    mbs_export::formats::write_exudyn(file, floating);
    return file.string();
  }
  if (arguments.format == "sid") {
    return write(target_of(arguments, source, ".SID_FEM"),
                 formats::sid_fem(floating, sid_options(arguments)));
  }
  const auto version = arguments.format == "mbdyn" ? mbs_export::formats::MbdynVersion::v1_7
                                                   : mbs_export::formats::MbdynVersion::develop;
  return write(target_of(arguments, source, ".fem"),
               mbs_export::formats::mbdyn_fem(floating, version));
}

/// @return the files written
std::vector<std::string> export_as(const ExportArguments& arguments)
{
  const Source source = source_of(arguments);
  const mbs_export::ReducedSystem reduced = mbs_export::read_reduced(source.reduced_file);
  if (arguments.format == "nastran-dmig")
    return {
        write(target_of(arguments, source, ".dmig"), mbs_export::formats::nastran_dmig(reduced))};
  if (arguments.format == "nastran-op4") return export_superelement(arguments, source, reduced);
  return {export_floating_body(arguments, source, floating_body_of(arguments, source, reduced))};
}

void export_and_report(const ExportArguments& arguments)
{
  const std::vector<std::string> files = export_as(arguments);
  for (const std::string& file : files) fmt::print("wrote {}\n", file);
  write_summary({.scene = arguments.source, .output = {}, .json = arguments.json},
                {{"source", arguments.source},
                 {"format", arguments.format},
                 {"files", report::Json::array({files.begin(), files.end()})}},
                report::cost_so_far({}));
}

}  // namespace

const std::vector<std::string>& export_formats()
{
  static const std::vector<std::string> names{"nastran-dmig",  "nastran-op4", "mbdyn",
                                              "mbdyn-develop", "sid",         "exudyn"};
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

void export_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { export_and_report(arguments.exported); });
}

}  // namespace chladni::cli
