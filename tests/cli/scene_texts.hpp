#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/scene/scene.hpp"
#include "common/error.hpp"

/// Scenes, mistakes in them, and the messages that these give.
namespace chladni::cli::testing {

/// The thesis disc, short; the numbers of its lines stand in the tests below.
inline const std::string disc = R"(title = "Disc"
[mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
element_order = 3
element_size = 0.0078
rings = [{ name = "track", radius = 0.13, nodes = 60 }]
[material.iron]
young = 9e10
poisson = 0.3
density = 6300.0
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.02
[[coupling]]
type = "rigid"
name = "hub"
group = "inner_edge"
[interface]
nodes = ["track", "hub"]
[reduce]
method = "craig-bampton"
modes = 100
[body]
fixed = ["hub"]
keep = { modes = 40 }
interface_modes = [{ kind = "frm", at = "track", dofs = ["z"], omega0 = "auto" }]
damping = { type = "none" }
[squeal]
ring = "track"
thickness = 0.03
use_modes = "nodal-diameters 3"
speeds = { from_rad_s = 3.0, to_rad_s = 63.0, count = 60 }
friction = 0.6
contact = "bilateral"
pads = [{ angle_deg = 90.0, stiffness = 6e6, damping = 1.0, preload = 2000.0 }]
analyses = ["eigenvalues", "growth", "transient"]
transient = { speed_rad_s = 19.0, duration_s = 6.0, initial_pad_displacement = 7e-8 }
growth = { speeds_rad_s = [12.0, 13.0], duration_s = 0.3 }
)";

inline std::string replaced(const std::string& text, const std::string& old_part,
                            const std::string& new_part)
{
  const std::size_t at = text.find(old_part);
  if (at == std::string::npos) throw Error("the test replaces what is not there: " + old_part);
  return text.substr(0, at) + new_part + text.substr(at + old_part.size());
}

inline std::string error_of(const std::string& text)
{
  try {
    parse_scene(text, "scene.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A change of the disc and the whole message that it must give.
struct Mistake {
  std::string old_part;
  std::string new_part;
  std::string message;
};

inline void expect_messages(const std::vector<Mistake>& mistakes)
{
  for (const Mistake& mistake : mistakes) {
    EXPECT_EQ(error_of(replaced(disc, mistake.old_part, mistake.new_part)), mistake.message)
        << mistake.new_part;
  }
}

inline const std::string rigid_disc = R"(name = "rigid"
[squeal]
model = "rigid disc"
rigid_disc = { diametral_inertia = 0.16, axial_inertia = 0.32, stiffness = 1.88e7, damping = 0.1, pad_radius = 0.13 }
thickness = 0.02
friction = { kinetic = 0.4, static = 0.6, decay_speed = 0.5 }
pads = [{ stiffness = 6e6, cubic_stiffness = 1e13, damping = 5.0, preload = 3000.0 }]
speeds = { from_rad_s = 3.0, to_rad_s = 63.0, count = 20 }
analyses = ["eigenvalues", "growth"]
growth = { speeds_rad_s = [12.0], duration_s = 3.0 }
)";

inline const std::string oscillator = R"([squeal]
model = "oscillator"
oscillator = { mass = 1.0, stiffness_along = 1.2e7, stiffness_normal = 4e6, stiffness_coupling = 1e6, damping_along = 5.0, damping_normal = 6.0, contact_stiffness = 7e6, preload = 500.0, radius = 0.13 }
friction = 0.3
speeds = { from_rad_s = 3.0, to_rad_s = 63.0, count = 20 }
analyses = ["critical-speed"]
)";

/// A planar beam; the numbers of its lines stand in the tests below.
inline const std::string beam = R"(title = "Beam"
[mesh]
generator = "beam"
start = [0.0, 0.0, 0.0]
end = [3.0, 0.0, 4.0]
elements = 10
points = [{ name = "B", distance = 2.5 }]
[model]
dofs = ["ry", "z"]
[material.iron]
young = 9e10
poisson = 0.3
density = 6300.0
[[section]]
group = "beam"
type = "beam"
material = "iron"
theory = "bernoulli-euler"
rotary_inertia = "none"
orientation = [1.0, 0.0, 0.0]
area = 1e-2
I_y = 1e-6
I_z = 2e-6
J = 3e-6
[interface]
nodes = ["start", "B"]
[reduce]
method = "craig-bampton"
modes = 10
resultants = ["beam"]
[body]
fixed = ["start.z"]
)";

/// The beam with a mass, a spring to the ground and a damper between its ends.
inline const std::string with_points = beam + R"([[mass]]
at = "end"
mass = 2.5
inertia = [1.0, 2.0, 2.5]
offset = [0.0, 0.0, 0.1]
[[spring]]
at = "B"
stiffness = { z = 1e6, ry = 20.0 }
[[spring]]
at = "start"
to = "end"
damping = { x = 35.0 }
)";

}  // namespace chladni::cli::testing
