#include "squeal/models/tilting_block.hpp"

namespace chladni::squeal {
namespace {

/// An end of the foot at the distance s from the centre of mass, along the motion of the surface.
SlidingPoint end_of_foot(const TiltingBlock& o, double s)
{
  return {.along = Eigen::Vector3d{1.0, 0.0, -o.height},
          .normal = Eigen::Vector3d{0.0, 1.0, s},
          .stiffness = 0.5 * o.contact_stiffness,
          .preload = 0.5 * o.preload};
}

}  // namespace

SlidingMasses sliding_masses(const TiltingBlock& o)
{
  return {.M = Eigen::Vector3d{o.mass, o.mass, o.inertia},
          .D = Eigen::Vector3d{o.d_x, o.d_y, o.d_phi}.asDiagonal().toDenseMatrix(),
          .K = Eigen::Vector3d{o.k_x, o.k_y, o.k_phi}.asDiagonal().toDenseMatrix(),
          .points = {end_of_foot(o, o.foot_offset - 0.5 * o.foot_length),
                     end_of_foot(o, o.foot_offset + 0.5 * o.foot_length)},
          .observed = 1,
          .radius = o.radius,
          .friction = o.friction,
          .law = o.law};
}

Places places_in(TiltingBlock& o)
{
  return {{"friction", &o.friction.kinetic},
          {"preload", &o.preload},
          {"stiffness", &o.contact_stiffness},
          {"tilting_block.mass", &o.mass},
          {"tilting_block.inertia", &o.inertia},
          {"tilting_block.stiffness_along", &o.k_x},
          {"tilting_block.stiffness_normal", &o.k_y},
          {"tilting_block.stiffness_tilting", &o.k_phi},
          {"tilting_block.damping_along", &o.d_x},
          {"tilting_block.damping_normal", &o.d_y},
          {"tilting_block.damping_tilting", &o.d_phi},
          {"tilting_block.height", &o.height},
          {"tilting_block.foot_length", &o.foot_length},
          {"tilting_block.foot_offset", &o.foot_offset},
          {"tilting_block.contact_stiffness", &o.contact_stiffness},
          {"tilting_block.preload", &o.preload},
          {"tilting_block.radius", &o.radius}};
}

}  // namespace chladni::squeal
