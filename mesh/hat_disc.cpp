#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "mesh/generators.hpp"
#include "mesh/mesher.hpp"
#include "mesh/rings.hpp"
#include "mesh/sectors.hpp"
#include "mesh/structured_disc.hpp"
#include "mesh/sweep.hpp"

namespace chladni::mesh {

namespace {

/// @throws chladni::Error unless the numbers ascend, with their names.
void check_ascending(const std::vector<std::pair<const char*, double>>& lengths)
{
  for (std::size_t i = 0; i + 1 < lengths.size(); ++i) {
    if (lengths[i].second < lengths[i + 1].second) continue;
    throw Error(fmt::format("hat_disc: {} = {} m must be less than {} = {} m", lengths[i].first,
                            lengths[i].second, lengths[i + 1].first, lengths[i + 1].second));
  }
}

void check_rings(const HatDiscOptions& o)
{
  const double row = o.edge_row.value_or(0.0);
  for (const RingOptions& ring : o.rings) {
    if (ring.radius > o.wall_radius && ring.radius < o.outer_radius - row) continue;
    throw Error(
        fmt::format("hat_disc: ring \"{}\" of radius {} m is not on the disc between the "
                    "wall and the outer edge with its row, {} and {:.6g} m",
                    ring.name, ring.radius, o.wall_radius, o.outer_radius - row));
  }
}

void check_bolts(const HatDiscOptions& o)
{
  if (!o.bolts) return;
  if (o.pattern == Pattern::structured)
    throw Error("hat_disc: bolts need pattern = \"unstructured\" or \"triangles\"");
  const double c = o.bolts->circle_radius;
  const double r = o.bolts->hole_radius + o.edge_row.value_or(0.0);
  check_ascending({{"0", 0.0}, {"bolts.hole_radius", o.bolts->hole_radius}});
  check_ascending(
      {{"bolts.hole_radius with its row", r},
       {"half the distance of two bolts", c * std::sin(std::numbers::pi / o.bolts->count)}});
  check_ascending({{"hub_radius with its row", o.hub_radius + o.edge_row.value_or(0.0)},
                   {"the inmost point of a bolt's hole", c - r},
                   {"its outmost point", c + r},
                   {"top_radius", o.top_radius}});
}

void check(const HatDiscOptions& o)
{
  check_ascending({{"0", 0.0}, {"hub_radius", o.hub_radius}, {"top_radius", o.top_radius}});
  check_ascending({{"0", 0.0}, {"wall_radius", o.wall_radius}, {"outer_radius", o.outer_radius}});
  check_ascending({{"foot", o.foot}, {"height", o.height}});
  if (!(o.foot >= 0.0)) throw Error(fmt::format("hat_disc: foot = {} m is below the disc", o.foot));
  if (!(o.inner_radius > 0.0 && o.inner_radius <= o.wall_radius)) {
    throw Error(
        fmt::format("hat_disc: inner_radius = {} m must be > 0 and at most wall_radius = "
                    "{} m",
                    o.inner_radius, o.wall_radius));
  }
  if (o.edge_row) {
    check_edge_rows(*o.edge_row, o.outer_radius - o.wall_radius);
    check_edge_rows(*o.edge_row, o.top_radius - o.hub_radius);
    if (o.inner_radius < o.wall_radius)
      check_edge_rows(*o.edge_row, o.wall_radius - o.inner_radius);
  }
  check_rings(o);
  check_bolts(o);
  check_pattern_of_sectors(o.sectors, o.pattern);
}

}  // namespace

Mesh hat_disc(const HatDiscOptions& options)
{
  check(options);
  Mesh mesh = options.pattern == Pattern::structured ? structured_hat_disc(options)
                                                     : made_by_mesher({.hat_disc = options});
  std::vector<RingOptions> rings = options.rings;
  for (RingOptions& ring : rings) ring.z = 0.0;
  add_rings(mesh, rings);
  return mesh;
}

}  // namespace chladni::mesh
