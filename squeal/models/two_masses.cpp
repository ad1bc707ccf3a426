#include "squeal/models/two_masses.hpp"

namespace chladni::squeal {

SlidingMasses sliding_masses(const TwoMasses& o)
{
  return {.M = Eigen::Vector2d{o.m_1, o.m_2},
          .D = Eigen::Vector2d{o.d_1, o.d_2}.asDiagonal().toDenseMatrix(),
          .K = Eigen::Vector2d{o.k_1, o.k_2}.asDiagonal().toDenseMatrix(),
          .points = {{.along = Eigen::Vector2d{1.0, -1.0},
                      .normal = Eigen::Vector2d::Zero(),
                      .stiffness = 0.0,
                      .preload = o.preload}},
          .observed = 0,
          .radius = o.radius,
          .friction = o.friction,
          .law = ContactLaw::signed_force};
}

Places places_in(TwoMasses& o)
{
  return {{"friction", &o.friction.kinetic},     {"preload", &o.preload},
          {"two_masses.pad_mass", &o.m_1},       {"two_masses.pad_stiffness", &o.k_1},
          {"two_masses.pad_damping", &o.d_1},    {"two_masses.disc_mass", &o.m_2},
          {"two_masses.disc_stiffness", &o.k_2}, {"two_masses.disc_damping", &o.d_2},
          {"two_masses.preload", &o.preload},    {"two_masses.radius", &o.radius}};
}

}  // namespace chladni::squeal
