#include "mesh/structured_disc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "mesh/sectors.hpp"
#include "mesh/sweep.hpp"

namespace chladni::mesh {

namespace {

/// Around the z axis, or over the first of equal sectors.
/// @throws chladni::Error when the elements around do not divide among the sectors.
Path turn(int n_elements, int order, int sectors)
{
  if (n_elements % sectors != 0) {
    throw Error(
        fmt::format("sectors = {} does not divide the {} elements around the disc; take a "
                    "divisor, or another element_size",
                    sectors, n_elements));
  }
  const auto position = [sectors](const Station& s, double t) {
    const double angle = 2.0 * std::numbers::pi * t / sectors;
    return std::array{s[0] * std::cos(angle), s[0] * std::sin(angle), s[1]};
  };
  return {.n_elements = n_elements / sectors,
          .closed = sectors == 1,
          .order = order,
          .position = position};
}

Profile level(const std::string& group, const std::vector<double>& radii, double z)
{
  Profile profile{.group = group, .stations = {}};
  for (const double r : radii) profile.stations.push_back({r, z});
  return profile;
}

/// From the flange down to the disc, so that its normal points outwards.
Profile wall_profile(const HatDiscOptions& o)
{
  const double slant = std::hypot(o.wall_radius - o.top_radius, o.height - o.foot);
  Profile profile{.group = "wall", .stations = {}};
  for (const double s : cut({0.0, slant}, o.element_size)) {
    const double part = s / slant;
    profile.stations.push_back({o.top_radius + part * (o.wall_radius - o.top_radius),
                                o.height + part * (o.foot - o.height)});
  }
  profile.stations.back() = {o.wall_radius, o.foot};
  return profile;
}

std::vector<double> disc_radii(const AnnulusOptions& o)
{
  std::vector<double> radii{o.inner_radius, o.outer_radius};
  for (const RingOptions& ring : o.rings) radii.push_back(ring.radius);
  return o.edge_row ? with_edge_rows(radii, *o.edge_row) : radii;
}

std::vector<double> disc_radii(const HatDiscOptions& o)
{
  std::vector<double> radii{o.inner_radius, o.outer_radius, o.wall_radius};
  for (const RingOptions& ring : o.rings) radii.push_back(ring.radius);
  if (!o.edge_row) return radii;
  if (o.inner_radius < o.wall_radius) return with_edge_rows(radii, *o.edge_row);
  radii.push_back(o.outer_radius - *o.edge_row);
  return radii;
}

std::vector<double> flange_radii(const HatDiscOptions& o)
{
  std::vector<double> radii{o.hub_radius, o.top_radius};
  if (o.edge_row) radii.push_back(o.hub_radius + *o.edge_row);
  return radii;
}

}  // namespace

Mesh structured_annulus(const AnnulusOptions& o)
{
  const double h = o.element_size;
  const int n = n_elements_around(o.outer_radius, h, o.rings, o.sectors);
  const std::vector<Profile> profiles{level("disc", cut(disc_radii(o), h), 0.0)};
  Swept swept = sweep(profiles, turn(n, o.element_order, o.sectors));
  add_row_group(swept, {o.inner_radius, 0.0}, "inner_edge");
  add_row_group(swept, {o.outer_radius, 0.0}, "outer_edge");
  find_sector_edges(swept.mesh, o.sectors);
  return swept.mesh;
}

Mesh structured_hat_disc(const HatDiscOptions& o)
{
  const double h = o.element_size;
  const int n = n_elements_around(o.outer_radius, h, o.rings, o.sectors);
  const std::vector<Profile> profiles{level("disc", cut(disc_radii(o), h), 0.0), wall_profile(o),
                                      level("flange", cut(flange_radii(o), h), o.height)};
  Swept swept = sweep(profiles, turn(n, o.element_order, o.sectors));
  if (o.inner_radius < o.wall_radius) add_row_group(swept, {o.inner_radius, 0.0}, "inner_edge");
  add_row_group(swept, {o.outer_radius, 0.0}, "outer_edge");
  add_row_group(swept, {o.wall_radius, 0.0}, "wall_seat");
  if (o.foot > 0.0) add_row_group(swept, {o.wall_radius, o.foot}, "wall_foot");
  add_row_group(swept, {o.hub_radius, o.height}, "hub_edge");
  find_sector_edges(swept.mesh, o.sectors);
  return swept.mesh;
}

}  // namespace chladni::mesh
