#include "cli/reserve_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <ios>
#include <iterator>

#include "common/error.hpp"
#include "mbs_export/files/body_files.hpp"
#include "report/text_table.hpp"

namespace chladni::cli {

namespace {

using std::filesystem::path;

constexpr std::string_view before = "<!-- written by Chladni for ", after = " -->\n";

/// What could end a comment, or begin another line, as %XX.
std::string encoded(const std::string& text)
{
  std::string all;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = std::isalnum(byte) != 0 || c == '/' || c == '.' || c == '_' || c == ' ';
    all += is_plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return all;
}

std::string decoded(const std::string& text)
{
  std::string all;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    const bool is_coded = text[i] == '%' && i + 2 < text.size();
    if (is_coded) std::from_chars(&text[i + 1], &text[i + 1] + 2, byte, 16);
    all += is_coded ? static_cast<char>(byte) : text[i];
    if (is_coded) i += 2;
  }
  return all;
}

/// The scene's file named by the comment at the end of a file; empty if there is none.
std::string marked_writer(const std::filesystem::path& file)
{
  constexpr std::streamoff longest = 16384;  // three times that of a path, and the words
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return "";
  in.seekg(std::max<std::streamoff>(0, std::streamoff(in.tellg()) - longest));
  const std::string end{std::istreambuf_iterator<char>(in), {}};
  const std::size_t at = end.rfind(before);
  if (at == std::string::npos || !end.ends_with(after)) return "";
  const std::size_t from = at + before.size();
  return decoded(end.substr(from, end.size() - after.size() - from));
}

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

std::string writer_mark(const SceneArguments& arguments)
{
  return fmt::format("{}{}{}", before, encoded(scene_file_of(arguments)), after);
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
