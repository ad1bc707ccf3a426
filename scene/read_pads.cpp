#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "scene/squeal_tables.hpp"

namespace chladni::scene {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// Whether one ring serves both contact planes.
enum class RingsOf { both_planes, each_plane };

squeal::Suspension read_suspension(const Table& table, std::string_view stiffness_unit)
{
  return {.stiffness = table.number("stiffness", {.above = 0.0, .unit = stiffness_unit}),
          .damping = table.number("damping")};
}

std::optional<squeal::Suspension> read_translation(const Table& body, std::string_view key)
{
  if (!body.has(key)) return std::nullopt;
  return read_suspension(body.table(key), "N/m");
}

std::optional<squeal::RotarySuspension> read_rotation(const Table& body, std::string_view key)
{
  if (!body.has(key)) return std::nullopt;
  const Table table = body.table(key);
  return squeal::RotarySuspension{.inertia = table.number("inertia"),
                                  .suspension = read_suspension(table, "N m")};
}

std::optional<squeal::PadBody> read_body_of_pad(const Table& pad)
{
  if (!pad.has("body")) return std::nullopt;
  const Table table = pad.table("body");
  squeal::PadBody body{.mass = table.number("mass")};
  if (table.has("height")) body.height = table.number("height");
  body.radial = read_translation(table, "radial");
  body.tangential = read_translation(table, "tangential");
  body.axial = read_translation(table, "axial");
  body.about_radial = read_rotation(table, "about_radial");
  body.about_tangential = read_rotation(table, "about_tangential");
  body.about_axial = read_rotation(table, "about_axial");
  if (!body.radial && !body.tangential && !body.axial && !body.about_radial &&
      !body.about_tangential && !body.about_axial) {
    pad.refuse("body",
               "needs a suspension: radial, tangential, axial, about_radial, about_tangential or "
               "about_axial");
  }
  return body;
}

std::optional<squeal::Caliper> read_caliper(const Table& pad,
                                            const std::optional<squeal::PadBody>& body)
{
  if (!pad.has("caliper")) return std::nullopt;
  if (!body || !body->axial)
    pad.refuse("caliper", "carries the pads by their axial suspension: give body.axial");
  const Table table = pad.table("caliper");
  return squeal::Caliper{.mass = table.number("mass"), .axial = read_suspension(table, "N/m")};
}

std::optional<squeal::Shim> read_shim(const Table& pad, const std::optional<squeal::PadBody>& body)
{
  if (!pad.has("shim")) return std::nullopt;
  if (body && !body->axial)
    pad.refuse("shim", "lies behind the axial suspension of the plate: give body.axial");
  const Table table = pad.table("shim");
  return squeal::Shim{.stiffness = table.number("stiffness"),
                      .loss_factor = table.number("loss_factor"),
                      .frequency_Hz = table.number("frequency_Hz")};
}

/// The rings of a grid, or pairs of them where each contact plane has its own.
void read_grid_rings(squeal::PadGrid& grid, const Table& table, RingsOf of)
{
  if (of == RingsOf::both_planes)
    grid.rings = table.texts("rings");
  else
    for (const Table& pair : table.tables("rings")) {
      grid.rings.push_back(pair.text("inboard"));
      grid.opposite_rings.push_back(pair.text("outboard"));
    }
  if (grid.rings.empty()) table.refuse("rings", "must name at least one ring");
  std::vector<std::string> sorted = grid.rings;
  sorted.insert(sorted.end(), grid.opposite_rings.begin(), grid.opposite_rings.end());
  std::ranges::sort(sorted);
  if (std::ranges::adjacent_find(sorted) != sorted.end())
    table.refuse("rings", "must not name a ring twice");
}

std::optional<squeal::PadGrid> read_grid(const Table& pad, RingsOf of)
{
  if (!pad.has("grid")) return std::nullopt;
  const Table table = pad.table("grid");
  squeal::PadGrid grid{.sector = degree * table.number("sector_deg"),
                       .points = table.integer("points")};
  if (table.has("rings")) read_grid_rings(grid, table, of);
  return grid;
}

/// The radius of a round face.
std::optional<double> read_patch(const Table& pad)
{
  if (!pad.has("radius")) return std::nullopt;
  if (pad.has("grid")) {
    pad.refuse(
        "radius",
        "is for a round face, and `grid` gives the points of another; leave out one of them");
  }
  return pad.number("radius");
}

/// Most pad pairs of a brake, and contact points of all pads: far more than a brake has.
constexpr std::size_t pads_max = 1000, contacts_max = 10000;

std::size_t contacts_of(const std::vector<squeal::PadPair>& pads)
{
  std::size_t n = 0;
  for (const squeal::PadPair& pad : pads) {
    n += pad.grid ? static_cast<std::size_t>(pad.grid->points) *
                        std::max<std::size_t>(1, pad.grid->rings.size())
                  : 1;
  }
  return n;
}

squeal::PadPair read_pad(const Table& pad, RingsOf of)
{
  const squeal::PadSpring spring = read_pad_spring(pad);
  const std::optional<squeal::PadBody> body = read_body_of_pad(pad);
  return {.angle = degree * pad.number("angle_deg"),
          .stiffness = spring.linear,
          .damping = pad.number("damping"),
          .preload = pad.number("preload"),
          .cubic_stiffness = spring.cubic,
          .grid = read_grid(pad, of),
          .body = body,
          .caliper = read_caliper(pad, body),
          .shim = read_shim(pad, body),
          .friction = pad.has("friction") ? std::optional(read_friction(pad)) : std::nullopt,
          .area = pad.has("area") ? std::optional(pad.number("area")) : std::nullopt,
          .radius = read_patch(pad)};
}

}  // namespace

std::vector<squeal::PadPair> read_pads(const Table& squeal)
{
  const std::vector<Table> tables = squeal.tables("pads");
  if (tables.empty()) squeal.refuse("pads", "must hold at least one pad pair");
  if (tables.size() > pads_max) {
    squeal.refuse("pads",
                  fmt::format("are {} pad pairs; there may be {}", tables.size(), pads_max));
  }
  std::vector<squeal::PadPair> pads;
  const RingsOf of = squeal.is_table("ring") ? RingsOf::each_plane : RingsOf::both_planes;
  for (const Table& pad : tables) pads.push_back(read_pad(pad, of));
  const std::size_t n_contacts = contacts_of(pads);
  if (n_contacts > contacts_max) {
    squeal.refuse("pads", fmt::format("have {} contact points in all; there may be {}", n_contacts,
                                      contacts_max));
  }
  return pads;
}

}  // namespace chladni::scene
