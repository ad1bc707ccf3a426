#include <fmt/format.h>

#include "common/error.hpp"
#include "mesh/generators.hpp"
#include "mesh/mesher.hpp"
#include "mesh/rings.hpp"
#include "mesh/sectors.hpp"
#include "mesh/structured_disc.hpp"
#include "mesh/sweep.hpp"

namespace chladni::mesh {

namespace {

void check_radii(const AnnulusOptions& o)
{
  if (!(o.inner_radius > 0.0 && o.inner_radius < o.outer_radius)) {
    throw Error(fmt::format("annulus: 0 < inner_radius < outer_radius must hold, not {} and {} m",
                            o.inner_radius, o.outer_radius));
  }
  if (o.edge_row) check_edge_rows(*o.edge_row, o.outer_radius - o.inner_radius);
  check_pattern_of_sectors(o.sectors, o.pattern);
  const double row = o.edge_row.value_or(0.0);
  for (const RingOptions& ring : o.rings) {
    if (!(ring.radius > o.inner_radius + row && ring.radius < o.outer_radius - row)) {
      throw Error(
          fmt::format("annulus: ring \"{}\" of radius {} m is not between {:.6g} and "
                      "{:.6g} m, the edges with their rows of elements",
                      ring.name, ring.radius, o.inner_radius + row, o.outer_radius - row));
    }
  }
}

}  // namespace

Mesh annulus(const AnnulusOptions& options)
{
  check_radii(options);
  Mesh mesh = options.pattern == Pattern::structured ? structured_annulus(options)
                                                     : made_by_mesher({.annulus = options});
  add_rings(mesh, options.rings);
  return mesh;
}

}  // namespace chladni::mesh
