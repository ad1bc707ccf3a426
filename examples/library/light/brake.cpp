// From a body file to the speed at which its brake squeals: brake disc.body.h5
#include <cstdio>
#include <exception>
#include <numbers>

#include "mbs_export/files/body_files.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/stability/stability_search.hpp"
#include "squeal/study/study.hpp"

int main(int argc, char** argv)
try {
  namespace squeal = chladni::squeal;
  if (argc != 2) return std::fputs("usage: brake FILE.body.h5\n", stderr), 2;
  // 1. The body, and of its modes the pair with three nodal diameters on the ring of the pads.
  const auto body = chladni::mbs_export::read_body(argv[1]);
  const chladni::squeal::Disc disc =
      chladni::squeal::disc_on_ring(body, "track", {.nodal_diameters = 3});
  // 2. One pair of pads at the angle 0.
  const chladni::squeal::SquealOptions options{
      .ring = "track",
      .thickness = 0.02,
      .friction = {.kinetic = 0.6},
      .pads = {{.angle = 0.0, .stiffness = 6e6, .damping = 0.0, .preload = 2000.0}},
      .study = {.speeds = {.from = 3.0, .to = 60.0, .count = 20},
                .analyses = {"eigenvalues", "critical-speed"}}};
  // 3. Where the sliding disc loses its stability.
  const chladni::squeal::SquealResults results =
      chladni::squeal::run(squeal::FlexibleDisc(disc, options), options.study);
  if (!results.critical_speed) {
    const chladni::squeal::Stability stability =
        chladni::squeal::stability_of(results.speed_stability.value());
    return std::printf("no critical speed: %s\n", chladni::squeal::name_of(stability)), 0;
  }
  std::printf("squeals from %.4f pi rad/s on, at %.1f Hz\n",
              results.critical_speed->speed / std::numbers::pi,
              results.critical_speed->frequency_Hz);
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
