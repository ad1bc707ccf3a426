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

enum class Format { msh, geo, step, own };

Format format_of(const std::string& file)
{
  if (!std::filesystem::is_regular_file(file)) {
    throw Error(fmt::format(
        "mesh file {} does not exist; give the path of a .msh, .geo, .step, .unv, .med, .vtu, "
        ".bdf, .nas, .dat or .inp",
        file));
  }
  if (has_own_reader(file)) return Format::own;
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".msh") return Format::msh;
  if (extension == ".geo") return Format::geo;
  if (extension == ".step" || extension == ".stp") return Format::step;
  throw Error(
      fmt::format("mesh file {}: only .msh, .geo, .step, .unv, .med and .vtu files and decks of "
                  "Nastran (.bdf, .nas, .dat) and Abaqus (.inp) can be read",
                  file));
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
std::vector<std::string> open(const MeshOptions& options, Format format)
{
  if (options.trust != Trust::owner) check_no_options_beside(*options.file);
  if (format == Format::msh) check_msh_is_whole(*options.file);
  if (format == Format::step) return open_step(options);
  std::vector<std::string> notes;
  if (format == Format::geo) {
    const Complaints complaints;
    notes = open_geo(options);
    complaints.refuse_errors();
  }
  if (format == Format::msh) gmsh::open(*options.file);
  add_entity_groups(options);
  return notes;
}

}  // namespace

Mesh read_file(const MeshOptions& options, const std::function<void()>& before_reading)
{
  const Format format = format_of(*options.file);
  if (format == Format::own) {
    before_reading();
    return read_here(options);
  }
  const int order = format == Format::msh ? 0 : options.element_order.value_or(3);
  const double unit = format == Format::step ? 1e-3 : options.length_unit;
  std::vector<std::string> notes;
  const auto build = [&] {
    before_reading();
    notes = open(options, format);
    set_local_sizes(options, unit);
  };
  Mesh mesh = mesh_with_gmsh(build, order, options.line_groups);
  mesh.notes.insert(mesh.notes.begin(), notes.begin(), notes.end());
  scale(mesh, unit);
  return mesh;
}

}  // namespace chladni::mesh
