#include "squeal/brake/pads.hpp"

#include <array>
#include <complex>

namespace chladni::squeal {

PadContact pad_contact(const SquealOptions& options, const PadPair& pad, double radius)
{
  return {.radius = radius,
          .thickness = options.thickness,
          .friction = options.friction,
          .law = options.contact,
          .spring = {.linear = pad.stiffness, .cubic = pad.cubic_stiffness},
          .damping = pad.damping,
          .preload = pad.preload};
}

ContactDerivatives contact_derivatives(const PadContact& pad, double speed)
{
  using Complex = std::complex<double>;
  // Any step does: f(i h) / h has no difference in it, and h^2 is far below rounding.
  constexpr double step = 1e-30;
  ContactDerivatives D;
  for (int j = 0; j < 6; ++j) {
    std::array<Complex, 6> x{};
    x[static_cast<std::size_t>(j)] = Complex(0.0, step);
    const RingMotion<Complex> motion{x[0], x[1], x[2], x[3], x[4], x[5]};
    const RingForce<Complex> F = contact(pad, motion, speed).force;
    const Eigen::Vector3d column{F.F_w.imag(), F.F_r.imag(), F.F_t.imag()};
    (j < 3 ? D.D_a : D.D_p).col(j % 3) = column / step;
  }
  return D;
}

}  // namespace chladni::squeal
