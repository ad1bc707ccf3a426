#include <charconv>
#include <numbers>

#include "scene/read_tables.hpp"
#include "scene/squeal_tables.hpp"

namespace chladni::scene {
namespace {

void check_ring(const Table& table, std::string_view key, const std::string& ring,
                const Scene& scene)
{
  const std::vector<std::string> rings = ring_names(scene.mesh);
  if (!contains(rings, ring)) table.refuse(key, no_such_name("ring", ring, rings));
  if (!contains(scene.interface_nodes, ring)) {
    table.refuse(key, "must stand in interface.nodes too, or the body does not have it");
  }
}

std::string read_ring(const Table& squeal, const Scene& scene)
{
  const std::string ring = squeal.text("ring");
  check_ring(squeal, "ring", ring, scene);
  return ring;
}

/// The rings of all grids are those of the body.
void check_grids(const Table& squeal, const Scene& scene)
{
  for (const Table& pad : squeal.tables("pads")) {
    if (!pad.has("grid") || !pad.table("grid").has("rings")) continue;
    const Table grid = pad.table("grid");
    for (const std::string& ring : grid.texts("rings")) check_ring(grid, "rings", ring, scene);
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
  options.ring = read_ring(squeal, scene);
  options.thickness = squeal.number("thickness");
  options.modes = read_modes(squeal);
  options.friction = read_friction(squeal);
  options.contact = read_contact(squeal);
  options.pads = read_pads(squeal);
  check_grids(squeal, scene);
  options.study = read_study(squeal, StudyOf::body);
  options.study.rotation_method = read_rotation_method(squeal);
  return options;
}

}  // namespace chladni::scene
