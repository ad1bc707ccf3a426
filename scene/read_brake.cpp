#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "scene/readers.hpp"

namespace chladni::scene {

using squeal::ContactLaw;

namespace {

constexpr double one_degree = std::numbers::pi / 180.0;

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
  squeal::PadGrid grid{.sector = one_degree * table.number("sector_deg"),
                       .points = table.integer("points")};
  if (table.has("rings")) read_grid_rings(grid, table, of);
  return grid;
}

/// Whether the face is a point by name.
bool read_is_point(const Table& pad)
{
  if (!pad.has("face")) return false;
  if (pad.has("grid"))
    pad.refuse("face", "is that of `grid`, which gives its points; leave out one of them");
  const auto is_point = pad.choice<bool>("face", {{"round", false}, {"point", true}});
  if (is_point && pad.has("radius"))
    pad.refuse("face", "is a point, and `radius` is that of a round face; leave out one of them");
  if (!is_point && !pad.has("radius") && !pad.has("area"))
    pad.refuse("face", "is round, but of unknown size: give `radius` or `area`");
  return is_point;
}

/// The radius of a round face, 0 of a point by name.
std::optional<double> read_patch(const Table& pad)
{
  if (read_is_point(pad)) return 0.0;
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
  return {.angle = one_degree * pad.number("angle_deg"),
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

namespace {

/// A row of measured friction.
struct MeasuredRow {
  std::optional<double> temperature, pressure;
  squeal::FrictionCurve curve;
};

squeal::FrictionCurve read_curve(const Table& row)
{
  const std::vector<double> mu = row.numbers("mu");
  if (mu.empty()) row.refuse("mu", "must hold at least one coefficient");
  if (!row.has("speed_m_s")) {
    if (mu.size() != 1) row.refuse("mu", "must be one coefficient where the row has no speed_m_s");
    return squeal::friction_curve({0.0}, mu);
  }
  const std::vector<double> speeds = row.numbers("speed_m_s");
  for (std::size_t i = 1; i < speeds.size(); ++i)
    if (speeds[i] <= speeds[i - 1])
      row.refuse_element("speed_m_s", i, "must be larger than the one before");
  if (speeds.size() < 2) row.refuse("speed_m_s", "must hold at least two speeds");
  if (mu.size() != speeds.size()) row.refuse("mu", "must be as many as the numbers of speed_m_s");
  return squeal::friction_curve(speeds, mu);
}

MeasuredRow read_row(const Table& row)
{
  MeasuredRow measured{.temperature = {}, .pressure = {}, .curve = read_curve(row)};
  if (row.has("temperature_C")) measured.temperature = row.number("temperature_C");
  if (row.has("pressure_Pa")) measured.pressure = row.number("pressure_Pa");
  return measured;
}

/// The values that rows have of a key, ascending, each once; empty where no row has it.
std::vector<double> axis_of(const std::vector<MeasuredRow>& rows,
                            std::optional<double> MeasuredRow::*key)
{
  std::vector<double> values;
  for (const MeasuredRow& row : rows)
    if (row.*key) values.push_back(*(row.*key));
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// All rows have a key, or none.
void check_key(const std::vector<Table>& tables, const char* key)
{
  for (const Table& row : tables)
    if (row.has(key) != tables.front().has(key))
      tables.front().refuse("mu", std::string("all rows of the table need ") + key + ", or none");
}

/// A curve at each pressure of each temperature.
squeal::FrictionTable table_of(const Table& friction, const std::vector<MeasuredRow>& rows)
{
  squeal::FrictionTable table{.temperatures = axis_of(rows, &MeasuredRow::temperature),
                              .pressures = axis_of(rows, &MeasuredRow::pressure),
                              .curves = {}};
  const std::size_t n_T = std::max<std::size_t>(1, table.temperatures.size());
  const std::size_t n_p = std::max<std::size_t>(1, table.pressures.size());
  for (std::size_t i = 0; i < n_T * n_p; ++i) {
    const auto is_meant = [&](const MeasuredRow& row) {
      return (!row.temperature || *row.temperature == table.temperatures[i / n_p]) &&
             (!row.pressure || *row.pressure == table.pressures[i % n_p]);
    };
    if (std::ranges::count_if(rows, is_meant) != 1) {
      const auto said = [&](const std::vector<double>& axis, std::size_t at, const char* unit) {
        return axis.empty() ? std::string() : fmt::format(" {:.6g} {}", axis[at], unit);
      };
      friction.refuse(
          "table",
          fmt::format("must have one row for each temperature with each pressure; of{}{} "
                      "it has {}",
                      said(table.temperatures, i / n_p, "degrees Celsius"),
                      said(table.pressures, i % n_p, "Pa"), std::ranges::count_if(rows, is_meant)));
    }
    table.curves.push_back(std::ranges::find_if(rows, is_meant)->curve);
  }
  return table;
}

double read_temperature(const Table& friction, const squeal::FrictionTable& table)
{
  if (table.temperatures.empty()) {
    if (friction.has("temperature_C"))
      friction.refuse("temperature_C", "the rows of the table have no temperature_C");
    return 20.0;
  }
  return friction.number("temperature_C", {.at_least = table.temperatures.front(),
                                           .at_most = table.temperatures.back(),
                                           .unit = "degrees Celsius, those of the table"});
}

/// Measured friction: mu = factor table(v, p) at a temperature.
squeal::FrictionLaw read_measured(const Table& friction)
{
  for (const char* key : {"kinetic", "static", "decay_speed"})
    if (friction.has(key)) friction.refuse(key, "`table` replaces this key; take this key out");
  const std::vector<Table> tables = friction.tables("table");
  if (tables.empty()) friction.refuse("table", "must hold at least one row");
  for (const char* key : {"temperature_C", "pressure_Pa"}) check_key(tables, key);
  std::vector<MeasuredRow> rows;
  for (const Table& row : tables) rows.push_back(read_row(row));
  const squeal::FrictionTable table = table_of(friction, rows);
  squeal::FrictionLaw law{.kinetic = friction.has("factor") ? friction.number("factor") : 1.0};
  if (friction.has("regularisation")) law.regularisation = friction.number("regularisation");
  law.temperature = read_temperature(friction, table);
  law.table = std::make_shared<const squeal::FrictionTable>(table);
  return law;
}

}  // namespace

squeal::FrictionLaw read_friction(const Table& of)
{
  if (!of.is_table("friction")) return {.kinetic = of.number("friction")};
  const Table table = of.table("friction");
  if (table.has("table")) return read_measured(table);
  squeal::FrictionLaw law{.kinetic = table.number("kinetic")};
  if (table.has("static")) {
    law.rise = table.number("static") - law.kinetic;
    law.decay_speed = table.number("decay_speed");
  }
  if (table.has("regularisation")) law.regularisation = table.number("regularisation");
  return law;
}

squeal::FrictionLaw read_plain_friction(const Table& squeal)
{
  if (squeal.is_table("friction") && squeal.table("friction").has("table")) {
    squeal.table("friction")
        .refuse("table", "is for a flexible disc; give this model kinetic, static and decay_speed");
  }
  return read_friction(squeal);
}

squeal::ContactLaw read_contact(const Table& squeal)
{
  if (!squeal.has("contact")) return ContactLaw::unilateral;
  return squeal.choice<ContactLaw>("contact", {{"unilateral", ContactLaw::unilateral},
                                               {"bilateral", ContactLaw::bilateral},
                                               {"signed", ContactLaw::signed_force}});
}

squeal::PadSpring read_pad_spring(const Table& pad)
{
  squeal::PadSpring spring{.linear = pad.number("stiffness")};
  if (pad.has("cubic_stiffness")) spring.cubic = pad.number("cubic_stiffness");
  return spring;
}

}  // namespace chladni::scene
