#pragma once

#include <vector>

#include "mesh/generators.hpp"
#include "mesh/partition.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate::testing {

inline mesh::Mesh small_disc()
{
  return mesh::annulus({.inner_radius = 0.025,
                        .outer_radius = 0.162,
                        .element_size = 0.03,
                        .element_order = 3,
                        .rings = {{.name = "track", .radius = 0.13, .nodes = 12}}});
}

inline const std::vector<Coupling> hub{{.name = "hub", .group = "inner_edge"}};

inline const std::vector<ShellSection> section{
    {.group = "disc",
     .material = {.young = 9.15915e10, .poisson = 0.3, .density = 6300.0},
     .thickness = 0.02}};

}  // namespace chladni::plate::testing
