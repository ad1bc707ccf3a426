#pragma once

#include "squeal/models/rigid_disc.hpp"

namespace chladni::squeal::test {

/// Steinbrecher 2015, table 3.1 (moments of inertia in kg m^2).
inline RigidDisc source_disc(ContactLaw law = ContactLaw::bilateral)
{
  return {.Theta = 0.16,
          .Phi = 0.32,
          .k_t = 1.88e7,
          .d_t = 0.1,
          .radius = 0.13,
          .thickness = 0.02,
          .spring = {6e6},
          .damping = 5.0,
          .preload = 3000.0,
          .friction = {0.6},
          .law = law};
}

}  // namespace chladni::squeal::test
