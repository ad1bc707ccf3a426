#include "mesh/mesh_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mesh/element_types.hpp"
#include "mesh/nodal_matrices.hpp"

namespace chladni::mesh {

namespace {

/// The order of the parts, for both directions.
void transfer_block(auto& archive, auto& block)
{
  archive(block.shape);
  archive(block.order);
  archive(block.nodes_per_element);
  archive(block.numbers);
  archive(block.nodes);
  archive(block.group);
}

void transfer_group(auto& archive, auto& group)
{
  archive(group.name);
  archive(group.dimension);
  archive(group.nodes);
}

void transfer_face_node(auto& archive, auto& on_face)
{
  auto& [node, nodes, weights] = on_face;
  archive.all(node, nodes, weights);
}

void transfer_equation(auto& archive, auto& equation)
{
  archive(equation.place);
  archive.each(equation.terms, [](auto& a, auto& term) {
    auto& [node, component, factor] = term;
    a.all(node, component, factor);
  });
}

void transfer_mesh(auto& archive, auto& mesh)
{
  archive(mesh.node_numbers);
  archive(mesh.positions);
  archive.each(mesh.blocks, [](auto& a, auto& block) { transfer_block(a, block); });
  archive.each(mesh.groups, [](auto& a, auto& group) { transfer_group(a, group); });
  archive.each(mesh.notes, [](auto& a, auto& note) { a(note); });
  archive(mesh.sectors.count);
  archive(mesh.sectors.pairs);
  archive.each(mesh.face_nodes, [](auto& a, auto& on_face) { transfer_face_node(a, on_face); });
  archive.each(mesh.equations, [](auto& a, auto& equation) { transfer_equation(a, equation); });
  archive(mesh.made_by);
}

void transfer_section(auto& archive, auto& section)
{
  archive(section.group);
  archive(section.material);
}

void transfer_beam(auto& archive, auto& beam)
{
  transfer_section(archive, beam);
  archive(beam.area);
  archive(beam.I_y);
  archive(beam.I_z);
  archive(beam.J);
  archive(beam.shear_factor_y);
  archive(beam.shear_factor_z);
  archive(beam.orientation);
}

void transfer_declarations(auto& archive, auto& declared)
{
  archive.each(declared.materials, [](auto& a, auto& material) {
    a(material.name);
    a(material.young);
    a(material.poisson);
    a(material.density);
  });
  archive.each(declared.shells, [](auto& a, auto& shell) {
    transfer_section(a, shell);
    a(shell.thickness);
    a.optional(shell.table, [](auto& b, auto& table) {
      b(table.over);
      b(table.at);
      b(table.values);
    });
    a(shell.offset);
  });
  archive.each(declared.beams, [](auto& a, auto& beam) { transfer_beam(a, beam); });
  archive.each(declared.solids, [](auto& a, auto& solid) { transfer_section(a, solid); });
  archive.each(declared.couplings, [](auto& a, auto& coupling) {
    a(coupling.name);
    a(coupling.group);
    a(coupling.kind);
    a(coupling.to);
    a(coupling.at);
  });
  archive.each(declared.supports, [](auto& a, auto& support) {
    a(support.group);
    a(support.components);
  });
  archive.each(declared.masses, [](auto& a, auto& mass) {
    a(mass.at);
    a(mass.mass);
    for (auto& moment : mass.inertia) a(moment);
    for (auto& x : mass.offset) a(x);
  });
  archive.each(declared.springs, [](auto& a, auto& spring) {
    a(spring.at);
    a(spring.to);
    for (auto& k : spring.stiffness) a(k);
  });
  archive.each(declared.notes, [](auto& a, auto& note) { a(note); });
}

void transfer_matrices(auto& archive, auto& matrices)
{
  archive.all(matrices.n_components, matrices.K, matrices.M, matrices.C, matrices.H);
}

void require(bool holds, const char* what)
{
  if (!holds) throw Error(fmt::format("the mesh that Gmsh made has {}", what));
}

void check_nodes(const Mesh& mesh)
{
  require(mesh.node_numbers.size() == mesh.positions.size(), "nodes without a number");
  require(mesh.positions.size() < std::size_t(1) << 31, "more nodes than can be counted");
  require(std::ranges::all_of(mesh.node_numbers, [](std::int64_t number) { return number > 0; }),
          "a node whose number is not positive");
  for (const auto& x : mesh.positions) {
    require(std::ranges::all_of(x, [](double c) { return std::isfinite(c); }),
            "a node whose coordinates are not finite");
  }
}

/// Indices from `first` up to the number of things that they count.
void check_indices(const std::vector<int>& indices, int first, std::size_t n, const char* what)
{
  for (const int i : indices) require(i >= first && i < static_cast<int>(n), what);
}

void check_block(const ElementBlock& block, const Mesh& mesh)
{
  constexpr int highest_order = 20;
  require(block.order >= 1 && block.order <= highest_order, "elements of no order");
  require(block.shape >= Shape::line && block.shape <= Shape::wedge, "elements of no shape");
  const int n = n_nodes_of(block.shape, block.order);
  require(n > 0 && block.nodes_per_element == n, "elements with too few or too many nodes");
  require(block.numbers.size() < std::size_t(1) << 31, "more elements than can be counted");
  require(block.nodes.size() == block.numbers.size() * std::size_t(n), "elements without nodes");
  require(block.group.size() == block.numbers.size(), "elements without a group");
  check_indices(block.nodes, 0, mesh.positions.size(), "an element on a node that is not there");
  check_indices(block.group, -1, mesh.groups.size(), "an element in a group that is not there");
}

void check_unpacked(const Mesh& mesh)
{
  check_nodes(mesh);
  for (const ElementBlock& block : mesh.blocks) check_block(block, mesh);
  for (const Group& group : mesh.groups) {
    require(group.dimension >= 0 && group.dimension <= 3, "a group of no dimension");
    check_indices(group.nodes, 0, mesh.positions.size(), "a group of nodes that are not there");
  }
  for (const auto& [low, high] : mesh.sectors.pairs)
    check_indices({low, high}, 0, mesh.positions.size(), "a pair of nodes that are not there");
  for (const FaceNode& on_face : mesh.face_nodes) {
    check_indices({on_face.node}, 0, mesh.positions.size(), "a node on a face that is not there");
    check_indices(on_face.nodes, 0, mesh.positions.size(), "a face of nodes that are not there");
    require(on_face.nodes.size() == on_face.weights.size(), "a node on a face without weights");
  }
  for (const Equation& equation : mesh.equations) {
    require(!equation.terms.empty(), "an equation without terms");
    for (const auto& [node, component, factor] : equation.terms) {
      check_indices({node}, 0, mesh.positions.size(), "an equation of no node");
      require(component >= 0 && component < 6, "an equation of no component");
    }
  }
  if (!mesh.matrices) return;
  require(mesh.matrices->n_components.size() + mesh.face_nodes.size() == mesh.positions.size(),
          "matrices of other nodes");
  for (const auto* matrix : mesh.matrices->all())
    for (const auto& [row, column, value] : *matrix)
      check_indices({row, column}, 0, 6 * mesh.positions.size(), "an entry of no node");
}

}  // namespace

void pack(Packer& packer, const Mesh& mesh)
{
  transfer_mesh(packer, mesh);
  packer(bool(mesh.matrices));
  if (mesh.matrices) transfer_matrices(packer, *mesh.matrices);
}

Mesh unpack_mesh(Unpacker& unpacker)
{
  Mesh mesh;
  transfer_mesh(unpacker, mesh);
  bool has_matrices = false;
  unpacker(has_matrices);
  if (has_matrices) {
    NodalMatrices matrices;
    transfer_matrices(unpacker, matrices);
    mesh.matrices = std::make_shared<const NodalMatrices>(std::move(matrices));
  }
  require(unpacker.at_end(), "more bytes than it says");
  check_unpacked(mesh);
  return mesh;
}

void pack(Packer& packer, const Declarations& declared)
{
  transfer_declarations(packer, declared);
}

Declarations unpack_declarations(Unpacker& unpacker)
{
  Declarations declared;
  transfer_declarations(unpacker, declared);
  require(unpacker.at_end(), "more bytes than it says");
  return declared;
}

namespace {

void transfer_rings(auto& archive, auto& rings)
{
  archive.each(rings, [](auto& a, auto& ring) {
    auto& [name, radius, nodes, z, on, width] = ring;
    a.all(name, radius, nodes, z, on, width);
  });
}

// The bindings name all members: who adds one is asked for it here.

void transfer_annulus(auto& archive, auto& options)
{
  auto& [inner, outer, size, order, rings, pattern, edge_row, sectors] = options;
  archive.all(inner, outer, size, order, pattern, edge_row, sectors);
  transfer_rings(archive, rings);
}

void transfer_hat_disc(auto& archive, auto& options)
{
  auto& [inner, outer, wall, top, hub, height, foot, size, order, rings, pattern, edge_row, bolts,
         sectors] = options;
  archive.all(inner, outer, wall, top, hub, height, foot, size, order, pattern, edge_row, sectors);
  transfer_rings(archive, rings);
  archive.optional(bolts, [](auto& a, auto& holes) {
    auto& [count, circle, hole] = holes;
    a.all(count, circle, hole);
  });
}

void transfer_pad(auto& archive, auto& options)
{
  auto& [inner, outer, angle, centre, size, order, pattern, edge_row] = options;
  archive.all(inner, outer, angle, centre, size, order, pattern, edge_row);
}

void transfer_rectangle(auto& archive, auto& options)
{
  auto& [length, width, size, order, pattern, edge_row] = options;
  archive.all(length, width, size, order, pattern, edge_row);
}

void transfer_beam_mesh(auto& archive, auto& options)
{
  auto& [start, end, elements, size, points, order] = options;
  archive.all(start, end, elements, size, order);
  archive.each(points, [](auto& a, auto& point) {
    auto& [name, distance] = point;
    a.all(name, distance);
  });
}

void transfer_generators(auto& archive, auto& options)
{
  archive.optional(options.annulus, [](auto& a, auto& o) { transfer_annulus(a, o); });
  archive.optional(options.hat_disc, [](auto& a, auto& o) { transfer_hat_disc(a, o); });
  archive.optional(options.pad, [](auto& a, auto& o) { transfer_pad(a, o); });
  archive.optional(options.rectangle, [](auto& a, auto& o) { transfer_rectangle(a, o); });
  archive.optional(options.beam, [](auto& a, auto& o) { transfer_beam_mesh(a, o); });
  archive.optional(options.extrude, [](auto& a, auto& o) {
    auto& [from, to, layers] = o;
    a.all(from, to, layers);
  });
}

void transfer_options(auto& archive, auto& options)
{
  transfer_generators(archive, options);
  archive(options.file);
  archive(options.element_order);
  archive(options.element_size);
  archive(options.size_factor);
  archive.each(options.sizes, [](auto& a, auto& place) {
    a(place.x);
    a(place.size);
  });
  archive.each(options.parameters, [](auto& a, auto& parameter) {
    a(parameter.first);
    a(parameter.second);
  });
  archive(options.length_unit);
  archive.each(options.groups, [](auto& a, auto& group) {
    a(group.name);
    a.each(group.entities, [](auto& inner, auto& entity) { inner(entity); });
  });
  transfer_rings(archive, options.rings);
  archive.each(options.line_groups, [](auto& a, auto& name) { a(name); });
  archive.each(options.shell_groups, [](auto& a, auto& name) { a(name); });
  archive.each(options.solid_groups, [](auto& a, auto& name) { a(name); });
  archive.each(options.coupled_groups, [](auto& a, auto& name) { a(name); });
  archive(options.doubled_elements);
  archive(options.sectors);
  archive.optional(options.matrices, [](auto& a, auto& files) {
    auto& [stiffness, mass, damping, structural, dofs, force_unit] = files;
    a.all(stiffness, mass, damping, structural, dofs, force_unit);
  });
}

void transfer_limits(auto& archive, auto& limits)
{
  archive.optional(limits, [](auto& a, auto& l) { a.all(l.memory, l.seconds); });
}

}  // namespace

void pack(Packer& packer, const MeshOptions& options)
{
  transfer_options(packer, options);
}

MeshOptions unpack_options(Unpacker& unpacker)
{
  MeshOptions options;
  transfer_options(unpacker, options);
  return options;
}

void pack(Packer& packer, const std::optional<confinement::Limits>& limits)
{
  transfer_limits(packer, limits);
}

std::optional<confinement::Limits> unpack_limits(Unpacker& unpacker)
{
  std::optional<confinement::Limits> limits;
  transfer_limits(unpacker, limits);
  return limits;
}

}  // namespace chladni::mesh
