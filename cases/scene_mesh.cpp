#include "cases/scene_mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "cases/fe_model.hpp"
#include "cases/ranks.hpp"
#include "common/petsc.hpp"
#include "mesh/element_types.hpp"
#include "mesh/generators.hpp"
#include "mesh/mesh_archive.hpp"
#include "mesh/sectors.hpp"
#include "plate/refinement/refined_mesh.hpp"
#include "plate/sections/sections.hpp"
#include "report/progress.hpp"

namespace chladni::cases {

namespace {

/// The mesh of the first rank on all ranks.
mesh::Mesh broadcast(const mesh::Mesh& mesh)
{
  if (n_ranks() == 1) return mesh;
  std::vector<char> bytes;
  if (rank() == 0) {
    Packer packer;
    pack(packer, mesh);
    bytes = packer.bytes();
  }
  std::size_t size = bytes.size();
  MPI_Bcast(&size, sizeof(size), MPI_BYTE, 0, PETSC_COMM_WORLD);
  bytes.resize(size);
  constexpr std::size_t piece = std::size_t(1) << 30;  // an MPI count is an int
  for (std::size_t at = 0; at < size; at += piece) {
    const auto count = static_cast<int>(std::min(piece, size - at));
    MPI_Bcast(bytes.data() + at, count, MPI_BYTE, 0, PETSC_COMM_WORLD);
  }
  Unpacker unpacker(bytes);
  return mesh::unpack_mesh(unpacker);
}

}  // namespace

mesh::Mesh split(mesh::Mesh mesh, const Split& into)
{
  const auto refine = [&](const plate::Refinement& refinement) {
    mesh::Mesh finer = plate::refined(mesh, refinement).mesh;
    finer.notes = std::move(mesh.notes);
    finer.made_by = mesh.made_by;
    if (mesh.sectors.count > 1) mesh::find_sector_edges(finer, mesh.sectors.count);
    mesh = std::move(finer);
  };
  const int order = into.order.value_or(mesh.blocks.front().order);
  if (into.order) refine({.parts = 1, .order = order});
  for (int i = 0; i < into.halvings; ++i) refine({.parts = 2, .order = order});
  return mesh;
}

void set_split(mesh::MeshOptions& mesh, const Split& into)
{
  mesh.element_order = into.order;
  mesh.size_factor = std::ldexp(1.0, -into.halvings);
}

namespace {

/// True if one node of the group ends two edges of elements that are in it: two neighbours may be
/// two points.
bool holds_a_chain(const mesh::Group& group, const mesh::Mesh& mesh)
{
  std::vector<char> has(mesh.positions.size(), 0);
  for (const int node : group.nodes) has[std::size_t(node)] = 1;
  const auto is_in = [&](const std::vector<int>& edge) {
    return std::ranges::all_of(edge, [&](int node) { return has[std::size_t(node)] != 0; });
  };
  std::map<int, std::set<int>> others;  // ends of edges
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; !mesh::is_solid(block.shape) && e < block.n_elements(); ++e) {
      for (const std::vector<int>& edge : mesh::edges_of(block, e)) {
        if (!is_in(edge)) continue;
        others[edge.front()].insert(edge.back());
        others[edge.back()].insert(edge.front());
      }
    }
  }
  return std::ranges::any_of(others, [](const auto& of) { return of.second.size() > 1; });
}

/// Sets of nodes of files that know no edges; Gmsh's points are points, and rings keep the nodes
/// that they have.
void take_edges_of_nodes(mesh::Mesh& mesh, const mesh::MeshOptions& options)
{
  if (options.file && mesh::mesh_source(*options.file) == mesh::MeshSource::msh) return;
  std::vector<std::string> taken;
  for (mesh::Group& group : mesh.groups) {
    const bool is_ring = std::ranges::find(options.rings, group.name, &mesh::RingOptions::name) !=
                         options.rings.end();
    if (group.dimension > 0 || is_ring || !holds_a_chain(group, mesh)) continue;
    group.dimension = 1;
    taken.push_back(group.name);
  }
  if (taken.empty()) return;
  mesh.notes.push_back(fmt::format(
      "node sets with a row of neighbours, taken as edges: {}; nodes that accuracy puts between "
      "neighbours belong to them",
      fmt::join(taken, ", ")));
}

/// A node that lies further from its place on an edge than half the edge: those of a semicircle are
/// as far. The order of the nodes is another one then, and the Jacobian may be positive by chance.
void check_edges(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element)
{
  for (const std::vector<int>& edge : mesh::edges_of(block, element)) {
    const auto &a = mesh.positions[std::size_t(edge.front())],
               &b = mesh.positions[std::size_t(edge.back())];
    const double most = 0.5 * mesh::norm(mesh::minus(b, a));
    for (std::size_t i = 1; i + 1 < edge.size(); ++i) {
      const double share = double(i) / double(edge.size() - 1);
      std::array<double, 3> off = mesh.positions[std::size_t(edge[i])];
      for (std::size_t c = 0; c < 3; ++c) off[c] -= std::lerp(a[c], b[c], share);
      if (mesh::norm(off) <= most) continue;
      const auto number = [&](int node) { return mesh.node_numbers[std::size_t(node)]; };
      throw Error(fmt::format(
          "element {}: its node {} is not on the edge between its nodes {} and {}; put the nodes "
          "into the order of the file's format",
          block.numbers[std::size_t(element)], number(edge[i]), number(edge.front()),
          number(edge.back())));
    }
  }
}

/// Elements without a section, solids whose nodes are no element, and those without volume at an
/// integration point are named with their file.
void check_elements(const scene::Scene& scene, const mesh::Mesh& mesh)
{
  if (mesh.matrices) return;  // its elements are no model
  try {
    for (const mesh::ElementBlock& block : mesh.blocks) {
      if (!mesh::is_solid(block.shape)) continue;
      plate::check_solid_exists(block.shape, block.order);
      for (int e = 0; e < block.n_elements(); ++e) {
        plate::solid_of_mesh(mesh, block, e);
        check_edges(mesh, block, e);
      }
    }
    plate::map_sections(mesh, structure_of(scene));
  } catch (const Error& error) {
    const std::string what = error.what(), file = scene.mesh.file.value_or("the mesh");
    throw Error(what.find(file) != std::string::npos ? what : fmt::format("{}: {}", file, what));
  }
}

}  // namespace

mesh::Mesh mesh_scene(const scene::Scene& scene)
{
  mesh::Mesh mesh = mesh::generate(scene.mesh);
  if (!scene.accuracy || has_size(scene.mesh) || !scene.solids.empty()) return mesh;
  take_edges_of_nodes(mesh, scene.mesh);
  const auto halvings = static_cast<int>(std::lround(-std::log2(scene.mesh.size_factor)));
  return split(std::move(mesh), {.order = scene.mesh.element_order, .halvings = halvings});
}

void check_groups(const scene::Scene& scene, const mesh::Mesh& mesh)
{
  std::vector<std::string> names;
  for (const mesh::Group& group : mesh.groups) names.push_back(group.name);
  scene::check_groups(scene, names);
}

std::optional<std::string> note_of_overlap(const scene::Scene& scene, const mesh::Mesh& mesh)
{
  constexpr double worth_telling = 0.03;
  const plate::RibOverlap overlap = plate::rib_overlap(mesh, scene.sections);
  if (!(overlap.twice > worth_telling * overlap.mass)) return std::nullopt;
  return fmt::format(
      "surfaces that end on the mid-surface of another hold {:.3g} of {:.4g} kg twice, {:.1f} %, "
      "and are longer than they are: a ventilated disc is too heavy and too soft; let ribs end at "
      "the faces, or take solids (docs/how-to/meshes.md, Plates with ribs between them)",
      mesh.sectors.count * overlap.twice, mesh.sectors.count * overlap.mass,
      100.0 * overlap.twice / overlap.mass);
}

mesh::Mesh mesh_on_all_ranks(const scene::Scene& scene, const ChooseMesh& choose)
{
  mesh::Mesh mesh;
  on_first_rank([&] {
    mesh = mesh_scene(scene);
    for (const std::string& note : mesh.notes) report::tell_note(note);
    check_groups(scene, mesh);
    check_elements(scene, mesh);
    if (const auto note = note_of_overlap(scene, mesh)) report::tell_note(*note);
    if (choose) mesh = choose(std::move(mesh));
  });
  return broadcast(mesh);
}

namespace {

constexpr double most_of_geo = 4.0;  // times the sizes that it says
constexpr double infinite = std::numeric_limits<double>::infinity();

bool is_geo(const mesh::MeshOptions& mesh)
{
  return mesh.file && mesh::mesh_source(*mesh.file) == mesh::MeshSource::geo;
}

bool is_step(const mesh::MeshOptions& mesh)
{
  return mesh.file && mesh::mesh_source(*mesh.file) == mesh::MeshSource::step;
}

/// Visits the options of the generator that has surfaces; none of a beam.
template <class Visit>
void of_plane_generator(const mesh::MeshOptions& mesh, const Visit& visit)
{
  if (mesh.annulus) visit(*mesh.annulus);
  if (mesh.hat_disc) visit(*mesh.hat_disc);
  if (mesh.pad) visit(*mesh.pad);
  if (mesh.rectangle) visit(*mesh.rectangle);
}

/// The smallest of the lengths of a profile; of a formula nothing is known.
double least_value(const plate::Profile& profile)
{
  return profile.values.empty() ? infinite : std::ranges::min(profile.values);
}

/// Across the body between edges, m.
double width_of(const mesh::MeshOptions& mesh)
{
  if (mesh.annulus) return mesh.annulus->outer_radius - mesh.annulus->inner_radius;
  if (mesh.hat_disc) return mesh.hat_disc->outer_radius - mesh.hat_disc->wall_radius;
  if (mesh.rectangle) return std::min(mesh.rectangle->length, mesh.rectangle->width);
  if (mesh.pad) {
    const mesh::PadOptions& pad = *mesh.pad;
    return std::min(pad.outer_radius - pad.inner_radius,
                    0.5 * (pad.inner_radius + pad.outer_radius) * pad.angle);
  }
  if (!mesh.beam) return infinite;
  const auto& [x, y] = std::pair(mesh.beam->start, mesh.beam->end);
  return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
}

/// Structured elements have a corner at each node of a ring, and are at most four times as long in
/// the one direction as in the other.
double largest_beside_rings(const mesh::MeshOptions& mesh)
{
  constexpr double most = 3.5;
  double largest = infinite;
  const auto of = [&](const auto& disc) {
    if (disc.pattern != mesh::Pattern::structured) return;
    for (const mesh::RingOptions& ring : disc.rings)
      largest = std::min(largest, most * 2.0 * std::numbers::pi * disc.outer_radius / ring.nodes);
  };
  if (mesh.annulus) of(*mesh.annulus);
  if (mesh.hat_disc) of(*mesh.hat_disc);
  return largest;
}

/// Of bending waves in the shell or beam where they are shortest, m.
double wavelength(const scene::Scene& scene, double omega)
{
  double least = infinite;
  const auto of = [&](double bending, double mass) {
    least =
        std::min(least, 2.0 * std::numbers::pi * std::pow(bending / (mass * omega * omega), 0.25));
  };
  for (const plate::ShellSection& shell : scene.sections) {
    const double t = least_value(shell.thickness);
    if (t == infinite || shell.material.density <= 0.0) continue;
    const plate::Material& m = shell.material;
    of(m.young * t * t * t / (12.0 * (1.0 - m.poisson * m.poisson)), m.density * t);
  }
  for (const plate::BeamSection& beam : scene.beams) {
    if (beam.material.density <= 0.0) continue;
    of(beam.material.young * std::min(beam.I_y, beam.I_z), beam.material.density * beam.area);
  }
  return least;
}

}  // namespace

bool has_size(const mesh::MeshOptions& mesh)
{
  return !mesh.file || is_geo(mesh) || is_step(mesh);
}

void set_size(mesh::MeshOptions& mesh, const MeshSize& size)
{
  const auto set = [&](auto& options) {
    options->element_size = size.size;
    options->element_order = size.order;
    options->edge_row = size.edge_row;
  };
  if (mesh.annulus) set(mesh.annulus);
  if (mesh.hat_disc) set(mesh.hat_disc);
  if (mesh.pad) set(mesh.pad);
  if (mesh.rectangle) set(mesh.rectangle);
  if (mesh.beam) {
    mesh.beam->element_size = size.size;
    mesh.beam->element_order = size.order;
  }
  if (!mesh.file) return;
  mesh.element_order = size.order;
  mesh.sizes = size.places;
  if (is_step(mesh)) mesh.element_size = size.size;
  if (is_geo(mesh)) mesh.size_factor = size.size;
}

int order_of(const mesh::MeshOptions& mesh)
{
  constexpr int usual = 3;
  int order = mesh.beam ? mesh.beam->element_order : mesh.element_order.value_or(usual);
  of_plane_generator(mesh, [&](const auto& options) { order = options.element_order; });
  return order;
}

std::optional<double> edge_row_of(const mesh::MeshOptions& mesh)
{
  std::optional<double> row;
  of_plane_generator(mesh, [&](const auto& options) { row = options.edge_row; });
  return row;
}

std::vector<int> other_orders(const mesh::MeshOptions& mesh)
{
  bool has_triangles = !mesh.beam;
  of_plane_generator(mesh, [&](const auto& options) {
    has_triangles = options.pattern != mesh::Pattern::structured;
  });
  std::vector<int> orders{2, 3, 4};
  if (has_triangles) orders.pop_back();
  std::erase(orders, order_of(mesh));
  return orders;
}

bool takes_local_sizes(const mesh::MeshOptions& mesh)
{
  return is_geo(mesh) || is_step(mesh);
}

bool takes_edge_row(const mesh::MeshOptions& mesh, double width)
{
  constexpr double share = 0.25;  // of the body, for two rows
  return !mesh.file && !mesh.beam && width < share * width_of(mesh);
}

double largest_size(const mesh::MeshOptions& mesh)
{
  constexpr double of_width = 0.5;
  if (is_geo(mesh)) return most_of_geo;
  return std::min(of_width * width_of(mesh), largest_beside_rings(mesh));
}

double rounded(double size)
{
  const double digit = std::pow(10.0, std::floor(std::log10(size)) - 1.0);
  return std::round(size / digit) * digit;
}

std::string described(const MeshSize& size)
{
  std::string text =
      fmt::format("element_order = {}, element_size = {:.2g}", size.order, size.size);
  if (size.edge_row) text += fmt::format(", edge_row = {:.3g}", *size.edge_row);
  if (!size.places.empty()) {
    const double least = std::ranges::min(size.places, {}, &mesh::SizeAt::size).size;
    text += fmt::format(", elements down to {:.2g} m where the error is", least);
  }
  return text;
}

double first_size(const scene::Scene& scene, double omega)
{
  constexpr double elements_of_wave = 3.0;
  const double largest = largest_size(scene.mesh);
  return is_geo(scene.mesh) ? 1.0 : std::min(wavelength(scene, omega) / elements_of_wave, largest);
}

double least_thickness(const scene::Scene& scene)
{
  double least = infinite;
  for (const plate::ShellSection& shell : scene.sections)
    least = std::min(least, least_value(shell.thickness));
  return least;
}

}  // namespace chladni::cases
