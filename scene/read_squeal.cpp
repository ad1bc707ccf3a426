#include <array>
#include <charconv>
#include <numbers>
#include <utility>

#include "scene/read_tables.hpp"
#include "scene/squeal_tables.hpp"

namespace chladni::scene {
namespace {

void check_ring(const Table& table, std::string_view key, const std::string& ring,
                const Scene& scene)
{
  const std::vector<std::string> rings = ring_names(scene.mesh);
  if (!contains(rings, ring)) table.refuse(key, no_such_name("ring", ring, rings));
  if (!contains(scene.interface_nodes, ring))
    table.refuse(key, "must also be in interface.nodes; otherwise the body does not contain it");
}

/// ring = "track", or { inboard = "track_in", outboard = "track_out" }: the second ring is empty
/// for one ring alone.
std::pair<std::string, std::string> read_rings(const Table& squeal, const Scene& scene)
{
  if (!squeal.is_table("ring")) {
    check_ring(squeal, "ring", squeal.text("ring"), scene);
    return {squeal.text("ring"), {}};
  }
  const Table ring = squeal.table("ring");
  for (const char* key : {"inboard", "outboard"}) check_ring(ring, key, ring.text(key), scene);
  if (ring.text("inboard") == ring.text("outboard")) {
    ring.refuse("outboard",
                "must be another ring than inboard; one ring for both planes is ring = \"NAME\"");
  }
  return {ring.text("inboard"), ring.text("outboard")};
}

/// squeal.contact_planes = [lower, upper], m
std::optional<std::array<double, 2>> read_planes(const Table& squeal)
{
  if (!squeal.has("contact_planes")) return std::nullopt;
  const std::vector<double> z = squeal.numbers("contact_planes");
  if (z.size() != 2 || !(z[1] > z[0]))
    squeal.refuse("contact_planes", "must be [z of the lower plane, z of the upper one], in m");
  return std::array{z[0], z[1]};
}

/// The rings, what of them pads feel, and the contact planes.
void read_faces(squeal::SquealOptions& options, const Table& squeal, const Scene& scene)
{
  const auto [ring, opposite] = read_rings(squeal, scene);
  const std::optional<std::array<double, 2>> planes = read_planes(squeal);
  options.ring = ring;
  if (squeal.only_one_of({"thickness", "contact_planes"}) == "thickness")
    options.thickness = squeal.number("thickness");
  else
    options.thickness = (*planes)[1] - (*planes)[0];
  if (planes || !opposite.empty())
    options.planes = squeal::ContactPlanes{.opposite_ring = opposite, .heights = planes};
  if (!squeal.has("slopes_from")) return;
  options.slopes_from = squeal.texts("slopes_from");
  if (options.slopes_from.empty()) squeal.refuse("slopes_from", "must name at least one ring");
  for (const std::string& name : options.slopes_from)
    check_ring(squeal, "slopes_from", name, scene);
}

/// The rings of all grids are those of the body.
void check_grids(const Table& squeal, const Scene& scene)
{
  for (const Table& pad : squeal.tables("pads")) {
    if (!pad.has("grid") || !pad.table("grid").has("rings")) continue;
    const Table grid = pad.table("grid");
    if (!squeal.is_table("ring")) {
      for (const std::string& ring : grid.texts("rings")) check_ring(grid, "rings", ring, scene);
      continue;
    }
    for (const Table& pair : grid.tables("rings"))
      for (const char* key : {"inboard", "outboard"}) check_ring(pair, key, pair.text(key), scene);
  }
}

/// The n of "nodal-diameters n"; absent when the text is anything else.
std::optional<int> nodal_diameters(const std::string& text)
{
  constexpr std::string_view prefix = "nodal-diameters ";
  if (!text.starts_with(prefix)) return std::nullopt;
  int n = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + prefix.size(), end, n);
  if (error != std::errc{} || rest != end || n < 1) return std::nullopt;
  return n;
}

squeal::ModeChoice read_modes(const Table& squeal)
{
  squeal::ModeChoice modes;
  if (squeal.has("quasi_static_above_Hz"))
    modes.quasi_static_above = 2.0 * std::numbers::pi * squeal.number("quasi_static_above_Hz");
  if (!squeal.has("use_modes")) return modes;
  if (modes.quasi_static_above &&
      !(!squeal.is_list("use_modes") && squeal.text("use_modes") == "all"))
    squeal.refuse("quasi_static_above_Hz",
                  "needs use_modes = \"all\": modes that are named have their inertia");
  if (squeal.is_list("use_modes")) {
    modes.list = read_mode_list(squeal, "use_modes");
    return modes;
  }
  const std::string text = squeal.text("use_modes");
  modes.nodal_diameters = nodal_diameters(text);
  if (text != "all" && !modes.nodal_diameters) {
    squeal.refuse("use_modes",
                  "must be \"all\", \"nodal-diameters N\" with N >= 1, or a list of mode numbers");
  }
  return modes;
}

}  // namespace

bool read_radiation(const Table& root)
{
  if (!root.has("squeal")) return false;
  const Table squeal = root.table("squeal");
  return squeal.has("radiation") && squeal.truth("radiation");
}

std::optional<squeal::SquealOptions> read_squeal(const Table& root, const Scene& scene)
{
  if (!root.has("squeal")) return std::nullopt;
  const Table squeal = root.table("squeal");
  squeal::SquealOptions options{};
  read_faces(options, squeal, scene);
  options.modes = read_modes(squeal);
  options.friction = read_friction(squeal);
  options.contact = read_contact(squeal);
  options.pads = read_pads(squeal);
  check_grids(squeal, scene);
  if (squeal.has("asymmetry")) {
    options.keeps_asymmetry =
        squeal.choice<bool>("asymmetry", {{"averaged", false}, {"kept", true}});
  }
  options.study = read_study(squeal, StudyOf::body);
  options.study.rotation_method = read_rotation_method(squeal);
  return options;
}

}  // namespace chladni::scene
