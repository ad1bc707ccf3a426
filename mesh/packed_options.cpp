#include "mesh/packed_options.hpp"

namespace chladni::mesh {
namespace {

void transfer_rings(auto& archive, auto& rings)
{
  archive.each(rings, [](auto& a, auto& ring) {
    auto& [name, radius, nodes, z] = ring;
    a.all(name, radius, nodes, z);
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
  archive.each(options.coupled_groups, [](auto& a, auto& name) { a(name); });
  archive(options.doubled_elements);
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
