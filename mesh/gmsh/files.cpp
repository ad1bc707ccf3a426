#include "mesh/gmsh/files.hpp"

#include <fmt/format.h>
#include <gmsh.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "common/error.hpp"
#include "mesh/check_msh.hpp"
#include "mesh/geo_code.hpp"

namespace chladni::mesh {

namespace {

using Statements = std::vector<std::string>;

/// A .geo in memory that sets the parameters before it includes another one, and reads them
/// afterwards; Gmsh's own -setnumber would hold for the whole process. Gmsh 4.8.4 does not obey the
/// last statement of a file that it opens and whose last line does not end, but that of an included
/// one.
class GeoAround {
 public:
  explicit GeoAround(const MeshOptions& options)
      : descriptor_{::memfd_create("parameters", MFD_CLOEXEC)}
  {
    std::string code;
    for (const auto& [name, value] : options.parameters)
      code += fmt::format("{} = {:.17g};\n", name, value);
    code += fmt::format("Include \"{}\";\n", std::filesystem::absolute(*options.file).string());
    for (const auto& [name, value] : options.parameters)
      code += fmt::format("SetNumber(\"Chladni/{}\", {});\n", name, name);
    if (::write(descriptor_, code.data(), code.size()) != std::ssize(code))
      throw Error("cannot set the parameters of a .geo: no file in memory");
  }
  ~GeoAround() { ::close(descriptor_); }
  GeoAround(const GeoAround&) = delete;
  GeoAround& operator=(const GeoAround&) = delete;

  std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

 private:
  int descriptor_;
};

bool is_name(const std::string& text)
{
  const auto is_of_a_name = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) == 0 &&
         std::ranges::all_of(text, is_of_a_name);
}

/// Whether the file is included by another one, which needs its name as a text.
bool is_included(const MeshOptions& options, const std::string& text)
{
  return !options.parameters.empty() || !text.ends_with('\n');
}

/// What stands in GEO code must not end its text or its statement.
void check_can_be_included(const MeshOptions& options)
{
  for (const auto& [name, value] : options.parameters) {
    if (is_name(name)) continue;
    throw Error(
        fmt::format("mesh file {}: \"{}\" is no name of a parameter; a name has letters, "
                    "digits and underscores",
                    *options.file, name));
  }
  const auto breaks = [](unsigned char c) { return c == '"' || std::iscntrl(c) != 0; };
  if (std::ranges::none_of(std::filesystem::absolute(*options.file).string(), breaks)) return;
  throw Error(
      fmt::format("mesh file {}: a geometry with parameters, or without a line break at its end, "
                  "cannot stand in a folder with a quote or a control character in its name; "
                  "rename it",
                  *options.file));
}

/// @throws chladni::Error for a command that the process which reads a stranger's file cannot obey.
void check_commands(const std::string& file, const Statements& code)
{
  const std::string command = acting_command(code);
  if (command.empty()) return;
  throw Error(
      fmt::format("mesh file {}: its command {} would start a program or write a file; take "
                  "it out, or, if the file is your own, say --trust-mesh",
                  file, command));
}

void check_parameters_are_used(const MeshOptions& options, const Statements& code)
{
  for (const auto& [name, value] : options.parameters) {
    if (has_word(code, name) || has_word(code, "Include") || has_word(code, "Merge")) continue;
    throw Error(fmt::format("mesh file {} has no parameter {}", *options.file, name));
  }
}

void check_parameters_held(const MeshOptions& options)
{
  for (const auto& [name, value] : options.parameters) {
    std::vector<double> at_end;
    gmsh::onelab::getNumber("Chladni/" + name, at_end);
    if (at_end.size() == 1 && at_end[0] == value) continue;
    throw Error(fmt::format(
        "mesh file {} overwrites the parameter {} = {}; write DefineConstant[{} = ...] in it "
        "instead of an assignment",
        *options.file, name, value, name));
  }
}

/// @return a note, if the algorithm was replaced
std::vector<std::string> replace_algorithm_8(const Statements& code)
{
  double algorithm = 0.0;
  gmsh::option::getNumber("Mesh.Algorithm", algorithm);
  const bool of_a_surface = sets_algorithm_8_of_a_surface(code);
  if (algorithm != 8.0 && !of_a_surface) return {};
  gmsh::option::setNumber("Mesh.Algorithm", 6);
  std::vector<std::pair<int, int>> surfaces;
  if (of_a_surface) gmsh::model::getEntities(surfaces, 2);
  for (const auto& [dimension, tag] : surfaces) gmsh::model::mesh::setAlgorithm(dimension, tag, 6);
  return {"the .geo asks for Mesh.Algorithm 8, which crashes in Gmsh 4.8.4; it was meshed by 6"};
}

void check_does_not_mesh_itself(const std::string& file, const Statements& code)
{
  if (!has_mesh_command(code) || !sets_algorithm_8(code)) return;
  throw Error(
      fmt::format("mesh file {} meshes itself by Mesh.Algorithm 8, which crashes in Gmsh "
                  "4.8.4; take out its command \"Mesh 2;\" or use algorithm 6",
                  file));
}

}  // namespace

std::vector<std::string> open_geo(const MeshOptions& options)
{
  const std::string& file = *options.file;
  const std::string text = read_all(file);
  const Statements code = geo_statements(text);
  if (options.trust != Trust::owner) check_commands(file, code);
  if (is_included(options, text)) check_can_be_included(options);
  check_does_not_mesh_itself(file, code);
  check_parameters_are_used(options, code);
  gmsh::option::setNumber("Mesh.MeshSizeFactor", options.size_factor);
  if (is_included(options, text)) {
    const GeoAround around(options);
    gmsh::open(around.path());
    check_parameters_held(options);
  } else {
    gmsh::open(file);
  }
  return replace_algorithm_8(code);
}

}  // namespace chladni::mesh
