#include <algorithm>

#include "scene/read_tables.hpp"

namespace chladni::scene {
namespace {

using mbs_export::Damping;
using mbs_export::InterfaceModes;
using mbs_export::KeptModes;

const std::vector<std::string> component_names = {"x", "y", "z", "rx", "ry", "rz"};

/// "hub" or "hub.rz": the set must be an interface node, the component one of the six.
void check_fixed(const Table& body, std::size_t i, const std::vector<std::string>& interface_nodes)
{
  const std::string name = body.texts("fixed")[i];
  if (contains(interface_nodes, name)) return;
  const std::size_t dot = name.rfind('.');
  const std::string set = name.substr(0, dot);
  if (!contains(interface_nodes, set))
    body.refuse_element("fixed", i, no_such_name("interface node", set, interface_nodes));
  if (!contains(component_names, name.substr(dot + 1)))
    body.refuse_element("fixed", i, "the component must be one of " + quoted_list(component_names));
}

std::vector<std::string> read_fixed(const Table& body,
                                    const std::vector<std::string>& interface_nodes)
{
  if (!body.has("fixed")) return {};
  std::vector<std::string> fixed = body.texts("fixed");
  for (std::size_t i = 0; i < fixed.size(); ++i) check_fixed(body, i, interface_nodes);
  return fixed;
}

std::optional<mbs_export::Tolerance> tolerance_of(const std::optional<Accuracy>& accuracy)
{
  if (!accuracy) return std::nullopt;
  return mbs_export::Tolerance{.error = accuracy->error, .up_to_Hz = accuracy->up_to_Hz};
}

KeptModes read_kept_modes(const Table& body, const std::optional<Accuracy>& accuracy)
{
  KeptModes kept;
  if (!body.has("keep")) {
    kept.tolerance = tolerance_of(accuracy);
    return kept;
  }
  const Table keep = body.table("keep");
  if (keep.has("tolerance")) {
    kept.tolerance = {.error = keep.number("tolerance"), .up_to_Hz = keep.number("up_to_Hz")};
    return kept;
  }
  const std::string_view key = keep.only_one_of({"modes", "up_to_Hz", "list"});
  if (key == "modes") kept.count = keep.integer(key);
  if (key == "up_to_Hz") kept.up_to_Hz = keep.number(key);
  if (key == "list") kept.list = read_mode_list(keep, key);
  return kept;
}

std::optional<double> read_omega0(const Table& mode, InterfaceModes::Kind kind)
{
  if (kind == InterfaceModes::Kind::irm) {
    if (mode.has("omega0"))
      mode.refuse("omega0", "an IRM is static; take this key out, or use frm");
    return 0.0;
  }
  if (!mode.has("omega0")) return std::nullopt;
  if (mode.is_number("omega0")) return mode.number("omega0");
  if (mode.text("omega0") != "auto")
    mode.refuse("omega0", "must be \"auto\" or a number > 0 (rad/s)");
  return std::nullopt;
}

InterfaceModes::Space read_space(const Table& mode, InterfaceModes::Kind kind,
                                 reduce::Method method)
{
  using Space = InterfaceModes::Space;
  if (!mode.has("space")) return Space::reduced;
  const auto space =
      mode.choice<Space>("space", {{"reduced", Space::reduced}, {"full", Space::full}});
  if (space == Space::full && kind == InterfaceModes::Kind::irm) {
    mode.refuse("space",
                "the reduced system holds every static response already; take this key out");
  }
  if (space == Space::full &&
      (method != reduce::Method::craig_bampton && method != reduce::Method::guyan)) {
    mode.refuse("space",
                "responses of the whole model join fixed-interface modes, and a reduction with "
                "free masters has none; take this key out, or reduce with method "
                "\"craig-bampton\"");
  }
  return space;
}

InterfaceModes read_interface_mode(const Table& mode, const Scene& scene)
{
  const auto kind = mode.choice<InterfaceModes::Kind>(
      "kind", {{"irm", InterfaceModes::Kind::irm}, {"frm", InterfaceModes::Kind::frm}});
  const std::string at = mode.text("at");
  if (!contains(scene.interface_nodes, at))
    mode.refuse("at", no_such_name("interface node", at, scene.interface_nodes));
  return {.kind = kind,
          .at = at,
          .components = read_component_list(mode, "dofs"),
          .omega0 = read_omega0(mode, kind),
          .space = read_space(mode, kind, scene.reduce.method)};
}

/// One ratio for all modes, one for each, or a table over the frequency.
void read_ratios(Damping& damping, const Table& table)
{
  if (!table.has("ratio") || !table.is_table("ratio")) {
    damping.ratios = table.has("ratio") && table.is_list("ratio")
                         ? table.numbers("ratio")
                         : std::vector{table.number("ratio")};
    return;
  }
  const Table ratio = table.table("ratio");
  damping.at_Hz = ratio.numbers("at_Hz");
  damping.ratios = ratio.numbers("values");
  if (damping.at_Hz.size() < 2) ratio.refuse("at_Hz", "must hold at least two frequencies");
  for (std::size_t i = 1; i < damping.at_Hz.size(); ++i)
    if (damping.at_Hz[i] <= damping.at_Hz[i - 1])
      ratio.refuse_element("at_Hz", i, "must be larger than the one before");
  if (damping.ratios.size() != damping.at_Hz.size())
    ratio.refuse("values", "must be as many as the numbers of at_Hz");
}

Damping read_damping(const Table& body)
{
  if (!body.has("damping")) return {};
  const Table table = body.table("damping");
  Damping damping;
  damping.type = table.choice<Damping::Type>("type", {{"none", Damping::Type::none},
                                                      {"modal", Damping::Type::modal},
                                                      {"rayleigh", Damping::Type::rayleigh},
                                                      {"matrix", Damping::Type::matrix}});
  if (damping.type == Damping::Type::modal) read_ratios(damping, table);
  if (damping.type == Damping::Type::rayleigh) {
    damping.alpha = table.number("alpha");
    damping.beta = table.number("beta");
  }
  return damping;
}

}  // namespace

std::array<double, 3> read_vector(const Table& table, std::string_view key)
{
  const std::vector<double> values = table.numbers(key);
  if (values.size() != 3) table.refuse(key, "must be three numbers [x, y, z]");
  return {values[0], values[1], values[2]};
}

std::array<double, 6> read_by_component(const Table& table, std::string_view key)
{
  const Table values = table.table(key);
  std::array<double, 6> by_component{};
  for (std::size_t c = 0; c < component_names.size(); ++c)
    if (values.has(component_names[c])) by_component[c] = values.number(component_names[c]);
  return by_component;
}

std::vector<int> read_component_list(const Table& table, std::string_view key)
{
  const std::vector<std::string> names = table.texts(key);
  if (names.empty()) table.refuse(key, "must name a component: " + quoted_list(component_names));
  std::vector<int> components;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = std::ranges::find(component_names, names[i]);
    if (found == component_names.end())
      table.refuse_element(key, i, "must be one of " + quoted_list(component_names));
    const int component = static_cast<int>(found - component_names.begin());
    if (std::ranges::find(components, component) != components.end())
      table.refuse_element(key, i, "is named twice");
    components.push_back(component);
  }
  return components;
}

std::vector<int> read_mode_list(const Table& table, std::string_view key)
{
  const std::vector<int> modes = table.integers(key);
  if (modes.empty()) table.refuse(key, "must name at least one mode, counted from 1");
  for (std::size_t i = 1; i < modes.size(); ++i)
    if (modes[i] <= modes[i - 1])
      table.refuse_element(key, i, "modes must ascend, each named once");
  return modes;
}

mbs_export::BodyOptions read_body(const Table& root, const Scene& scene)
{
  mbs_export::BodyOptions options;
  if (!root.has("body")) {
    options.keep.tolerance = tolerance_of(scene.accuracy);
    return options;
  }
  const Table body = root.table("body");
  options.fixed = read_fixed(body, scene.interface_nodes);
  options.keep = read_kept_modes(body, scene.accuracy);
  if (body.has("interface_modes"))
    for (const Table& mode : body.tables("interface_modes"))
      options.interface_modes.push_back(read_interface_mode(mode, scene));
  options.damping = read_damping(body);
  return options;
}

}  // namespace chladni::scene
