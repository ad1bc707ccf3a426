#include "mesh/gmsh/read_file.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <filesystem>
#include <string_view>

#include "common/error.hpp"
#include "mesh/check_msh.hpp"
#include "mesh/gmsh/files.hpp"
#include "mesh/gmsh/graded_sizes.hpp"
#include "mesh/gmsh/model.hpp"
#include "mesh/own_readers.hpp"

namespace chladni::mesh {

namespace {

MeshSource source_of(const std::string& file)
{
  if (!std::filesystem::is_regular_file(file)) {
    throw Error(
        fmt::format("mesh file {} does not exist; give the path of a {}", file, extensions_of()));
  }
  if (const auto source = mesh_source(file)) return *source;
  throw Error(fmt::format("mesh file {}: its name must end with {}", file, extensions_of()));
}

/// Gmsh runs the code of NAME.opt before it is done with NAME.
void check_no_options_beside(const std::string& file)
{
  const std::string options = file + ".opt";
  if (!std::filesystem::exists(std::filesystem::symlink_status(options))) return;
  throw Error(
      fmt::format("mesh file {}: beside it is the option file {}, which Gmsh would obey; move that "
                  "away, or, if both files are your own, say --trust-mesh",
                  file, options));
}

/// What Gmsh complains of while it lives, which it tells nobody else.
class Complaints {
 public:
  Complaints() { gmsh::logger::start(); }
  ~Complaints() { gmsh::logger::stop(); }
  Complaints(const Complaints&) = delete;
  Complaints& operator=(const Complaints&) = delete;

  /// @throws chladni::Error with the first error, which has file and line.
  void refuse_errors() const
  {
    constexpr std::string_view error = "Error: ";
    std::vector<std::string> lines;
    gmsh::logger::get(lines);
    for (const std::string& line : lines)
      if (line.starts_with(error)) throw Error("Gmsh: " + line.substr(error.size()));
  }
};

/// Opens the file in Gmsh, with its groups.
/// @return notes for the user
std::vector<std::string> open(const MeshOptions& options, MeshSource source)
{
  if (options.trust != Trust::owner) check_no_options_beside(*options.file);
  if (source == MeshSource::msh) check_msh_is_whole(*options.file);
  if (source == MeshSource::step) return open_step(options);
  std::vector<std::string> notes;
  if (source == MeshSource::geo) {
    const Complaints complaints;
    notes = open_geo(options);
    complaints.refuse_errors();
  }
  if (source == MeshSource::msh) gmsh::open(*options.file);
  add_entity_groups(options);
  return notes;
}

}  // namespace

Mesh read_file(const MeshOptions& options, const std::function<void()>& before_reading)
{
  const MeshSource source = source_of(*options.file);
  if (has_own_reader(*options.file)) {
    before_reading();
    return read_here(options);
  }
  const int order = source == MeshSource::msh ? 0 : options.element_order.value_or(3);
  const double unit = source == MeshSource::step ? 1e-3 : options.length_unit;
  std::vector<std::string> notes;
  const auto build = [&] {
    before_reading();
    notes = open(options, source);
    set_local_sizes(options, unit);
  };
  Mesh mesh = mesh_with_gmsh(build, order, options);
  mesh.notes.insert(mesh.notes.begin(), notes.begin(), notes.end());
  scale(mesh, unit);
  return mesh;
}

}  // namespace chladni::mesh
