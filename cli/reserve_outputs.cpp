#include "cli/reserve_outputs.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "cli/writer_mark.hpp"
#include "common/error.hpp"
#include "mbs_export/files/body_files.hpp"
#include "report/text_table.hpp"

namespace chladni::cli {

namespace {

using std::filesystem::path;

/// Of the scene that wrote a file; empty where the file does not tell.
std::string writer_of(const path& file)
{
  if (!is_regular_file(file)) return "";
  if (file.extension() == ".vtu" || file.extension() == ".html") return marked_writer(file);
  if (file.extension() != ".h5") return "";
  try {
    return mbs_export::file_parts::read_provenance(file).scene_file;
  } catch (const Error&) {  // damaged, or something else: nothing is lost with it
    return "";
  }
}

void refuse_that_of_another_scene(const SceneArguments& arguments, const path& file)
{
  const std::string writer = writer_of(file);
  const std::string own = scene_file_of(arguments);
  if (writer.empty() || writer == own || !exists(path(arguments.output) / writer)) return;
  throw Error(fmt::format(
      "{}: belongs to another scene, {}; give one of the scenes another `name`, choose another "
      "--output, or replace the file with --overwrite",
      file.string(), (path(arguments.output) / writer).lexically_normal().string()));
}

}  // namespace

std::string scene_file_of(const SceneArguments& arguments)
{
  std::error_code unknown;
  const path seen = std::filesystem::relative(arguments.scene, arguments.output, unknown);
  return unknown ? std::string() : seen.generic_string();
}

void tell_notes(const scene::Scene& scene)
{
  for (const std::string& note : scene.notes)
    fmt::print(stderr, "note: {}\n", report::printable(note));
}

ReservedOutputs reserve_outputs(const SceneArguments& arguments, const std::vector<path>& files)
{
  if (!files.empty()) report::make_folder(arguments.output);
  ReservedOutputs reserved;
  for (const path& file : files) {
    reserved.push_back(files::lock_output(file));
    if (!arguments.overwrite) refuse_that_of_another_scene(arguments, file);
  }
  if (!arguments.json.empty()) reserved.push_back(files::lock_output(arguments.json));
  return reserved;
}

}  // namespace chladni::cli
