#include "squeal/models/oscillator.hpp"

namespace chladni::squeal {

SlidingMasses sliding_masses(const Oscillator& o)
{
  return {.M = Eigen::Vector2d{o.mass, o.mass},
          .D = Eigen::Vector2d{o.d_x, o.d_y}.asDiagonal().toDenseMatrix(),
          .K = Eigen::Matrix2d{{o.k_x, o.k_xy}, {o.k_xy, o.k_y}},
          .points = {{.along = Eigen::Vector2d{1.0, 0.0},
                      .normal = Eigen::Vector2d{0.0, 1.0},
                      .stiffness = o.contact_stiffness,
                      .preload = o.preload}},
          .observed = 1,
          .radius = o.radius,
          .friction = o.friction,
          .law = o.law};
}

Places places_in(Oscillator& o)
{
  return {{"friction", &o.friction.kinetic},
          {"preload", &o.preload},
          {"stiffness", &o.contact_stiffness},
          {"oscillator.mass", &o.mass},
          {"oscillator.stiffness_along", &o.k_x},
          {"oscillator.stiffness_normal", &o.k_y},
          {"oscillator.stiffness_coupling", &o.k_xy},
          {"oscillator.damping_along", &o.d_x},
          {"oscillator.damping_normal", &o.d_y},
          {"oscillator.contact_stiffness", &o.contact_stiffness},
          {"oscillator.preload", &o.preload},
          {"oscillator.radius", &o.radius}};
}

double flutter_friction(const Oscillator& o)
{
  const double half = 0.5 * (o.k_x - o.k_y - o.contact_stiffness);
  return (half * half + o.k_xy * o.k_xy) / (o.k_xy * o.contact_stiffness);
}

}  // namespace chladni::squeal
