#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "common/error.hpp"
#include "mesh/coincident_nodes.hpp"
#include "mesh/generators.hpp"
#include "mesh/mesh_cache.hpp"
#include "mesh/mesher.hpp"
#include "mesh/quality.hpp"
#include "mesh/rings.hpp"
#include "mesh/sectors.hpp"

namespace chladni::mesh {

namespace {

/// Of a file whose numbers look like millimetres; empty where they do not.
std::string hint_of_unit(const Mesh& mesh, const MeshOptions& options)
{
  constexpr double wide = 20.0;  // m
  if (options.length_unit != 1.0 || mesh.positions.empty()) return "";
  double width = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto [least, most] = std::ranges::minmax(
        mesh.positions, {}, [c](const std::array<double, 3>& x) { return x[c]; });
    width = std::max(width, most[c] - least[c]);
  }
  if (width < wide) return "";
  return fmt::format(
      "the mesh is {:.4g} m wide; if it is in mm, say length_unit = \"mm\" in [mesh]", width);
}

void add_rings_or_hint(Mesh& mesh, const MeshOptions& options, const std::string& hint)
{
  try {
    add_rings(mesh, options.rings);
  } catch (const Error& error) {
    throw Error(hint.empty() ? error.what() : fmt::format("{}; {}", error.what(), hint));
  }
}

}  // namespace

Mesh read_gmsh(const MeshOptions& options)
{
  const std::string& file = options.file.value();
  try {
    Mesh made = kept_mesh(options, [&] { return made_by_mesher(options); });
    Mesh mesh = treat_coincident_nodes(std::move(made), options);
    find_sector_edges(mesh, options.sectors);
    const std::string hint = hint_of_unit(mesh, options);
    if (!hint.empty()) mesh.notes.push_back(hint);
    add_rings_or_hint(mesh, options, hint);
    return mesh;
  } catch (const Error& e) {
    const std::string text = e.what();
    throw Error(text.find(file) == std::string::npos ? fmt::format("mesh file {}: {}", file, text)
                                                     : text);
  }
}

namespace {

Mesh generated(const MeshOptions& options)
{
  if (options.annulus) return annulus(*options.annulus);
  if (options.hat_disc) return hat_disc(*options.hat_disc);
  if (options.pad) return pad(*options.pad);
  if (options.rectangle) return rectangle(*options.rectangle);
  return beam(options.beam.value());
}

/// What helps where curved edges fold elements over; empty where the order is not the scene's,
/// or 1.
std::string hint_of_order(const Mesh& mesh, const MeshOptions& options)
{
  const auto source = options.file ? mesh_source(*options.file) : std::nullopt;
  const bool is_chosen = !source || source == MeshSource::geo || source == MeshSource::step;
  int order = 1;
  for (const ElementBlock& block : mesh.blocks) order = std::max(order, block.order);
  if (!is_chosen || order == 1) return "";
  return fmt::format(
      ". Elements of order {} fold over where an edge is much curved: take smaller ones, or "
      "element_order = {} in [mesh]",
      order, order - 1);
}

}  // namespace

Mesh draft(const MeshOptions& options)
{
  if (options.file) return read_gmsh(options);
  return kept_mesh(options, [&] { return generated(options); });
}

Mesh generate(const MeshOptions& options)
{
  Mesh mesh = draft(options);
  try {
    check_usable(mesh, options.file ? fmt::format("mesh file {}", *options.file) : "the mesh");
  } catch (const Error& error) {
    throw Error(error.what() + hint_of_order(mesh, options));
  }
  return mesh;
}

}  // namespace chladni::mesh
