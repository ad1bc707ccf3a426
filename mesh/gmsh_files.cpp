#include "mesh/gmsh_files.hpp"

#include <fmt/format.h>
#include <gmsh.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/error.hpp"
#include "mesh/geo_code.hpp"

namespace chladni::mesh {

namespace {

std::string read_all(const std::string& file)
{
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

using Statements = std::vector<std::string>;

/// A .geo that sets the parameters before it includes another one, and reads them afterwards;
/// Gmsh's own -setnumber would hold for the whole process. Gone at the end of its scope.
class GeoWithParameters {
 public:
  explicit GeoWithParameters(const MeshOptions& options)
  {
    path_ = (std::filesystem::temp_directory_path() / "chladni_XXXXXX.geo").string();
    const int descriptor = ::mkstemps(path_.data(), 4);
    if (descriptor < 0) throw Error(fmt::format("cannot write a temporary file {}", path_));
    ::close(descriptor);
    std::ofstream out(path_);
    for (const auto& [name, value] : options.parameters) {
      out << fmt::format("{} = {:.17g};\n", name, value);
    }
    out << fmt::format("Include \"{}\";\n", std::filesystem::absolute(*options.file).string());
    for (const auto& [name, value] : options.parameters) {
      out << fmt::format("SetNumber(\"Chladni/{}\", {});\n", name, name);
    }
  }
  ~GeoWithParameters()
  {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  GeoWithParameters(const GeoWithParameters&) = delete;
  GeoWithParameters& operator=(const GeoWithParameters&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

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

void check_msh_is_whole(const std::string& file)
{
  const std::string text = read_all(file);
  if (text.rfind("$MeshFormat", 0) != 0 && text.find("\n$MeshFormat") == std::string::npos) {
    throw Error(fmt::format("mesh file {} is not a .msh of Gmsh: $MeshFormat is missing", file));
  }
  for (const std::string section :
       {"MeshFormat", "PhysicalNames", "Entities", "Nodes", "Elements"}) {
    const bool begun = text.find("$" + section + "\n") != std::string::npos ||
                       text.find("$" + section + "\r\n") != std::string::npos;
    const bool must_be_there = section == "Nodes" || section == "Elements";
    const bool ended = text.find("$End" + section) != std::string::npos;
    if (begun ? ended : !must_be_there) continue;
    throw Error(fmt::format("mesh file {} is cut off: ${}{} is missing", file, begun ? "End" : "",
                            section));
  }
}

std::vector<std::string> open_geo(const MeshOptions& options)
{
  const std::string& file = *options.file;
  const Statements code = geo_statements(read_all(file));
  check_does_not_mesh_itself(file, code);
  check_parameters_are_used(options, code);
  if (options.parameters.empty()) {
    gmsh::open(file);
  } else {
    const GeoWithParameters with_parameters(options);
    gmsh::open(with_parameters.path());
    check_parameters_held(options);
  }
  return replace_algorithm_8(code);
}

}  // namespace chladni::mesh
