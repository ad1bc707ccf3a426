#include "sound/air_of_gmsh.hpp"

namespace chladni::sound {
namespace {

// The bindings name all members: who adds one is asked for it here.

void transfer_outline(auto& archive, auto& outline)
{
  auto& [quadrilaterals, balls, holes, sheet_radius] = outline;
  archive.each(quadrilaterals, [](auto& a, auto& corners) {
    for (auto& corner : corners) a.all(corner[0], corner[1]);
  });
  archive.each(balls, [](auto& a, auto& ball) {
    auto& [z, radius] = ball;
    a.all(z, radius);
  });
  archive.each(holes, [](auto& a, auto& of_circle) {
    auto& [circle_radius, radius, count, angle] = of_circle;
    a.all(circle_radius, radius, count, angle);
  });
  archive(sheet_radius);
}

void transfer_question(auto& archive, auto& question)
{
  auto& [outline, options, dimension, centre] = question;
  transfer_outline(archive, outline);
  auto& [order, size, edge_size, growth, inner_radius, thickness, half_space] = options;
  archive.all(order, size, edge_size, growth, inner_radius, thickness, half_space);
  archive.all(dimension, centre);
}

void transfer_air(auto& archive, auto& air)
{
  auto& [order, n, reference, positions, elements] = air;
  archive.all(order, n, reference, positions, elements);
}

}  // namespace

void pack(Packer& packer, const AirQuestion& question)
{
  transfer_question(packer, question);
}

AirQuestion unpack_question(Unpacker& unpacker)
{
  AirQuestion question{};
  transfer_question(unpacker, question);
  return question;
}

void pack(Packer& packer, const AirOfGmsh& air)
{
  transfer_air(packer, air);
}

AirOfGmsh unpack_air(Unpacker& unpacker)
{
  AirOfGmsh air{};
  transfer_air(unpacker, air);
  return air;
}

}  // namespace chladni::sound
