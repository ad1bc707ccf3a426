#include "squeal/brake/pads.hpp"

namespace chladni::squeal {

std::array<PadFace, 2> faces_of_plate(double thickness, double radius)
{
  const double half = 0.5 * thickness;
  return {PadFace{.radius = radius, .plane = half, .distance = half},
          PadFace{.radius = radius, .plane = -half, .distance = -half}};
}

PadContact pad_contact(const SquealOptions& options, const PadPair& pad,
                       const std::array<PadFace, 2>& faces)
{
  return {.faces = faces,
          .friction = options.friction,
          .law = options.contact,
          .spring = {.linear = pad.stiffness, .cubic = pad.cubic_stiffness},
          .damping = pad.damping,
          .preload = pad.preload};
}

}  // namespace chladni::squeal
