#include "squeal/brake/pads.hpp"

#include <complex>
#include <numbers>

namespace chladni::squeal {

std::array<PadFace, 2> faces_of_plate(double thickness, double radius)
{
  const double half = 0.5 * thickness;
  return {PadFace{.radius = radius, .plane = half, .distance = half},
          PadFace{.radius = radius, .plane = -half, .distance = -half}};
}

Suspension in_series(const Suspension& spring, const Shim& shim)
{
  using Complex = std::complex<double>;
  const double omega = 2.0 * std::numbers::pi * shim.frequency_Hz;
  const Complex k(spring.stiffness, omega * spring.damping);
  const Complex k_s = shim.stiffness * Complex(1.0, shim.loss_factor);
  const Complex both = k * k_s / (k + k_s);
  return {.stiffness = both.real(), .damping = both.imag() / omega};
}

PadContact pad_contact(const SquealOptions& options, const PadPair& pad,
                       const std::array<PadFace, 2>& faces)
{
  Suspension lining{.stiffness = pad.stiffness, .damping = pad.damping};
  if (pad.shim && !pad.body) lining = in_series(lining, *pad.shim);
  return {.faces = faces,
          .friction = pad.friction.value_or(options.friction),
          .law = options.contact,
          .spring = {.linear = lining.stiffness, .cubic = pad.cubic_stiffness},
          .damping = lining.damping,
          .preload = pad.preload,
          .area = pad.area.value_or(0.0)};
}

}  // namespace chladni::squeal
