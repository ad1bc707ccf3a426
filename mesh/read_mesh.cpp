#include "mesh/read_mesh.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <regex>
#include <utility>

#include "common/confinement/helper_process.hpp"
#include "common/error.hpp"
#include "common/files/input_file.hpp"
#include "common/files/output_file.hpp"
#include "mesh/extrude.hpp"
#include "mesh/generators.hpp"
#include "mesh/mesh.hpp"
#include "mesh/mesh_archive.hpp"
#include "mesh/mesh_repair.hpp"
#include "mesh/mesher.hpp"
#include "mesh/nodal_matrices.hpp"
#include "mesh/quality.hpp"
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
    if (options.matrices) add_matrices(mesh, options);
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

Mesh generated(const MeshOptions& options);

/// The generator puts nodes on the circles of the rings, each once.
Mesh solids_over(MeshOptions flat)
{
  const Extrusion extrusion = *std::exchange(flat.extrude, std::nullopt);
  std::vector<RingOptions> rings;
  if (flat.annulus) {
    rings = flat.annulus->rings;
    std::vector<RingOptions> circles;
    for (RingOptions ring : rings) {
      if (ring.on == RingOn::face) continue;
      const auto same = std::ranges::find(circles, ring.radius, &RingOptions::radius);
      ring.z.reset();
      if (same == circles.end())
        circles.push_back(ring);
      else
        same->nodes = std::lcm(same->nodes, ring.nodes);
    }
    flat.annulus->rings = std::move(circles);
  }
  Mesh plane = generated(flat);
  std::erase_if(plane.groups, [&](const Group& group) {
    return std::ranges::find(rings, group.name, &RingOptions::name) != rings.end();
  });
  return extruded(plane, extrusion, rings);
}

Mesh generated(const MeshOptions& options)
{
  if (options.extrude) return solids_over(options);
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
  if (mesh.matrices) return mesh;  // its elements are no model
  try {
    check_usable(mesh, options.file ? fmt::format("mesh file {}", *options.file) : "the mesh");
  } catch (const Error& error) {
    throw Error(error.what() + hint_of_order(mesh, options));
  }
  return mesh;
}

namespace {

namespace fs = std::filesystem;

std::string digest_of(std::string_view bytes)
{
  const std::span all(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  const std::size_t whole = all.size() / files::Xxh64::stripe * files::Xxh64::stripe;
  files::Xxh64 digest;
  digest.add(all.first(whole));
  return fmt::format("{:016x}", digest.finish(all.subspan(whole)));
}

/// The program or library that an address is in.
std::string digest_of_home(const void* address)
{
  Dl_info info{};
  link_map* place = nullptr;
  const bool is_known =
      dladdr1(address, &info, reinterpret_cast<void**>(&place), RTLD_DL_LINKMAP) != 0;
  const bool is_library = is_known && place != nullptr && *place->l_name != '\0';
  return files::file_digest(is_library ? place->l_name : "/proc/self/exe");
}

/// Of this program and of the mesher: others may make other meshes. Empty if one cannot be read.
std::string digests_of_programs()
{
  const std::string own = digest_of_home(reinterpret_cast<const void*>(&digest_of_home));
  const std::string of_mesher =
      files::file_digest(confinement::helper(confinement::mesher).string());
  return own.empty() || of_mesher.empty() ? std::string() : own + of_mesher;
}

/// Where the mesher looks for its libraries, beside the places that the system has for them.
std::string library_folders()
{
  std::string all;
  for (const char* variable : {"LD_LIBRARY_PATH", "LD_PRELOAD"}) {
    const char* said = std::getenv(variable);
    all += fmt::format("{}={}\n", variable, said == nullptr ? "" : said);
  }
  return all;
}

std::string text_of(const fs::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Why the mesh of a file must be made each time; empty if its bytes decide on it.
std::string why_not_kept(const MeshOptions& options)
{
  const std::string& file = *options.file;
  if (options.trust == Trust::owner) return "--trust-mesh lets it depend on anything";
  if (is_deck(file)) return "a deck may include others";
  if (mesh_source(file) != MeshSource::geo) return "";
  static const std::regex other_files(
      "Include|Merge|File|System|GetEnv|GetString|Plugin|OnelabRun|Exists");
  return std::regex_search(text_of(file), other_files) ? "it may read other files" : "";
}

/// @param programs  digests of all that makes meshes
std::string key_of(const MeshOptions& options, const std::string& programs)
{
  Packer packer;
  packer(programs);
  packer(library_folders());
  pack(packer, options);
  if (options.file) packer(files::file_digest(*options.file));
  return digest_of({packer.bytes().data(), packer.bytes().size()});
}

constexpr std::string_view magic = "chladni mesh 2\n";
constexpr std::size_t digest_length = 16;

/// Of the library that made the mesh, as its file is now. What read a stranger's file may say
/// anything of itself.
std::string digest_of_library(const Mesh& mesh)
{
  std::error_code ignored;
  return fs::is_regular_file(mesh.made_by, ignored) ? files::file_digest(mesh.made_by) : "";
}

/// Nothing if there is no such file, it is not whole, or another library would make the mesh now.
std::optional<Mesh> kept(const fs::path& path)
{
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return std::nullopt;
  const std::string text = text_of(path);
  if (!text.starts_with(magic) || text.size() < magic.size() + digest_length) return std::nullopt;
  const std::string_view digest = std::string_view(text).substr(magic.size(), digest_length);
  const std::string_view packed = std::string_view(text).substr(magic.size() + digest_length);
  if (digest_of(packed) != digest) return std::nullopt;
  try {
    const std::vector<char> bytes(packed.begin(), packed.end());
    Unpacker unpacker(bytes);
    std::string library;
    unpacker(library);
    Mesh mesh = unpack_mesh(unpacker);
    const bool is_known = mesh.made_by.empty() || !library.empty();
    if (!is_known || digest_of_library(mesh) != library) return std::nullopt;
    return mesh;
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// @return what is to be told
std::string keep_for_later(const Mesh& mesh, const fs::path& path)
{
  Packer packer;
  packer(digest_of_library(mesh));
  pack(packer, mesh);
  const std::string_view packed(packer.bytes().data(), packer.bytes().size());
  std::string text(magic);
  text += digest_of(packed);
  text += packed;
  try {
    fs::create_directories(path.parent_path());
    files::write_text(path.string(), text);
    return fmt::format("the mesh is kept in {}", path.string());
  } catch (const std::exception& error) {
    return fmt::format("the mesh could not be kept: {}", error.what());
  }
}

}  // namespace

Mesh kept_mesh(const MeshOptions& options, const std::function<Mesh()>& make)
{
  if (!options.cache) return make();
  if (options.file) {
    files::regular_file_size(*options.file);
    const std::string reason = why_not_kept(options);
    if (!reason.empty()) {
      Mesh mesh = make();
      mesh.notes.push_back(fmt::format("the mesh of {} is not kept: {}", *options.file, reason));
      return mesh;
    }
  }
  const std::string programs = digests_of_programs();
  if (programs.empty()) {
    Mesh mesh = make();
    mesh.notes.emplace_back("the mesh is not kept: the programs that make it cannot be read");
    return mesh;
  }
  const std::string key = key_of(options, programs);
  const fs::path path = fs::path(*options.cache) / (key + ".mesh");
  if (std::optional<Mesh> mesh = kept(path)) {
    mesh->notes.push_back(fmt::format("the mesh is the one kept in {}", path.string()));
    return *std::move(mesh);
  }
  Mesh mesh = make();
  const bool is_as_before = key_of(options, programs) == key;
  mesh.notes.push_back(is_as_before ? keep_for_later(mesh, path)
                                    : "the mesh is not kept: its file was changed meanwhile");
  return mesh;
}

}  // namespace chladni::mesh
