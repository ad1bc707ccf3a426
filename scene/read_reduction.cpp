#include <fmt/format.h>

#include <algorithm>

#include "scene/read_mesh.hpp"
#include "scene/readers.hpp"

namespace chladni::scene {

using mbs_export::Damping, mbs_export::InterfaceModes, mbs_export::KeptModes;

namespace {

/// What may be an attachment: couplings, rings and, where the scene alone knows them, edges.
std::vector<std::string> attachable_names(const Scene& scene)
{
  std::vector<std::string> names = ring_names(scene.mesh);
  for (const plate::Coupling& coupling : scene.couplings)
    if (!coupling.name.empty()) names.push_back(coupling.name);
  for (const std::string& group : group_names(scene))
    if (!contains(names, group) && !contains(surface_groups(scene.mesh), group))
      names.push_back(group);
  for (const plate::Coupling& coupling : scene.couplings)
    if (coupling.kind != plate::CouplingKind::averaging) std::erase(names, coupling.group);
  return names;
}

void check_interface_node(const Table& interface, std::size_t i, const Scene& scene)
{
  const std::vector<std::string> nodes = interface.texts("nodes");
  const std::string& name = nodes[i];
  if (std::find(nodes.begin(), nodes.begin() + i, name) != nodes.begin() + i)
    interface.refuse_element("nodes", i, "is named twice");
  for (const plate::Coupling& coupling : scene.couplings) {
    if (coupling.group != name || coupling.kind == plate::CouplingKind::averaging) continue;
    interface.refuse_element(
        "nodes", i,
        coupling.has_reference_node()
            ? fmt::format("follows the reference node \"{0}\"; name \"{0}\" instead", coupling.name)
            : fmt::format("follows \"{0}\"; name \"{0}\" instead", coupling.to));
  }
  // The groups of a mesh file are known only once it is read.
  const std::vector<std::string> names = attachable_names(scene);
  if (!group_names(scene).empty() && !contains(names, name)) {
    const char* kind = scene.mesh.beam ? "point or coupling" : "ring, edge or coupling";
    interface.refuse_element("nodes", i, no_such_name(kind, name, names));
  }
}

}  // namespace

std::vector<std::string> read_interface(const Table& root, const Scene& scene)
{
  const Table interface = root.table("interface");
  std::vector<std::string> nodes = interface.texts("nodes");
  if (nodes.empty()) interface.refuse("nodes", "must name at least one ring, edge or coupling");
  for (std::size_t i = 0; i < nodes.size(); ++i) check_interface_node(interface, i, scene);
  return nodes;
}

std::vector<plate::RingHarmonics> read_ring_harmonics(const Table& root, const Scene& scene)
{
  const Table interface = root.table("interface");
  std::vector<plate::RingHarmonics> rings;
  if (!interface.has("rings")) return rings;
  for (const Table& ring : interface.tables("rings")) {
    plate::RingHarmonics wanted{.ring = ring.text("name"), .up_to = ring.integer("harmonics")};
    if (!contains(scene.interface_nodes, wanted.ring))
      ring.refuse("name", no_such_name("interface node", wanted.ring, scene.interface_nodes));
    if (std::ranges::find(rings, wanted.ring, &plate::RingHarmonics::ring) != rings.end())
      ring.refuse("name", "is given twice");
    const auto& made = rings_of(scene.mesh);
    const auto known = std::ranges::find(made, wanted.ring, &mesh::RingOptions::name);
    if (known != made.end() && 2 * wanted.up_to > known->nodes) {
      ring.refuse("harmonics", fmt::format("a ring of {} nodes has the harmonics 1 to {}",
                                           known->nodes, known->nodes / 2));
    }
    rings.push_back(std::move(wanted));
  }
  return rings;
}

namespace {

reduce::Method method_of(const Table& table)
{
  using enum reduce::Method;
  if (table.text("method") == "macneal") {
    table.refuse("method",
                 "MacNeal's method is gone, since it was no better than Craig-Bampton; take "
                 "\"rubin\", which has the same modes");
  }
  return table.choice<reduce::Method>("method", {{"auto", automatic},
                                                 {"craig-bampton", craig_bampton},
                                                 {"mixed-interface", mixed_interface},
                                                 {"guyan", guyan},
                                                 {"rubin", rubin}});
}

void refuse_without_tolerance(const Table& table, const char* key, reduce::Method method)
{
  if (reduce::keeps_tolerances(method)) return;
  table.refuse(key,
               "a tolerance needs method \"auto\", \"mixed-interface\" or \"craig-bampton\"; give "
               "modes or cutoff_Hz");
}

/// The method of a reduction that keeps an accuracy.
reduce::Method method_of_tolerance(const Table& table)
{
  const reduce::Method method = method_of(table);
  if (method == reduce::Method::guyan)
    table.refuse("method", "Guyan's method cannot keep an accuracy; take this key out");
  refuse_without_tolerance(table, "method", method);
  return method;
}

/// A tolerance implies the method that costs least.
reduce::Method read_method(const Table& table)
{
  using enum reduce::Method;
  if (!table.has("method") && table.has("tolerance")) return automatic;
  const reduce::Method method = method_of(table);
  if (method == automatic && !table.has("tolerance"))
    table.refuse("method", "\"auto\" chooses for a tolerance; give tolerance and up_to_Hz");
  return method;
}

/// With an accuracy nothing else may say what is kept.
reduce::ReduceOptions kept_by(const Accuracy& accuracy, const std::optional<Table>& table)
{
  if (table) {
    for (const char* key : {"modes", "cutoff_Hz", "tolerance", "up_to_Hz"})
      if (table->has(key)) table->refuse(key, "`accuracy` chooses what is kept; take this key out");
  }
  reduce::ReduceOptions options{.method = reduce::Method::automatic};
  if (table && table->has("method")) options.method = method_of_tolerance(*table);
  // Of the squares of the frequencies: what the mesh leaves of the accuracy.
  constexpr double share = 0.2;
  options.tolerance = {.tolerance = share * accuracy.error, .up_to_Hz = accuracy.up_to_Hz};
  return options;
}

std::optional<Table> optional_table(const Table& root)
{
  return root.has("reduce") ? std::optional(root.table("reduce")) : std::nullopt;
}

}  // namespace

std::optional<Accuracy> read_accuracy(const Table& root)
{
  if (!root.has("accuracy")) return std::nullopt;
  if (!root.is_table("accuracy")) {
    root.refuse("accuracy",
                "must say up to which frequency too: { error = 1e-3, up_to_Hz = 8000 }");
  }
  const Table table = root.table("accuracy");
  const Table mesh = root.table("mesh");
  return Accuracy{.error = table.number("error"),
                  .up_to_Hz = table.number("up_to_Hz"),
                  .chooses_order = !mesh.has("element_order"),
                  .chooses_edge_row = !mesh.has("edge_row")};
}

std::optional<int> read_ranks_per_harmonic(const Table& root)
{
  const std::optional<Table> table = optional_table(root);
  if (!table || !table->has("ranks_per_harmonic")) return std::nullopt;
  if (!root.table("mesh").has("sectors"))
    table->refuse("ranks_per_harmonic", "is for bodies of equal sectors; give `sectors` in [mesh]");
  return table->integer("ranks_per_harmonic");
}

bool read_mesh_errors(const Table& root, const std::optional<Accuracy>& accuracy)
{
  const std::optional<Table> table = optional_table(root);
  if (table && table->has("mesh_errors")) return table->truth("mesh_errors");
  return accuracy.has_value();
}

reduce::ReduceOptions read_reduce(const Table& root, const std::optional<Accuracy>& accuracy)
{
  if (accuracy) return kept_by(*accuracy, optional_table(root));
  const Table table = root.table("reduce");
  reduce::ReduceOptions options;
  options.method = read_method(table);
  if (options.method == reduce::Method::guyan) {
    for (const char* key : {"modes", "cutoff_Hz", "tolerance", "up_to_Hz"})
      if (table.has(key))
        table.refuse(key, "Guyan has no fixed-interface modes; take this key out");
    return options;
  }
  const std::string_view criterion = table.only_one_of({"modes", "cutoff_Hz", "tolerance"});
  if (criterion == "modes") {
    options.modes = table.integer("modes");
  } else if (criterion == "cutoff_Hz") {
    options.cutoff_Hz = table.number("cutoff_Hz");
  } else {
    refuse_without_tolerance(table, "tolerance", options.method);
    options.tolerance = {.tolerance = table.number("tolerance"),
                         .up_to_Hz = table.number("up_to_Hz")};
  }
  return options;
}

ResultantChoice read_resultants(const Table& root, const Scene& scene)
{
  if (!root.has("reduce") || !root.table("reduce").has("resultants")) return {};
  const Table table = root.table("reduce");
  std::vector<std::string> groups = table.texts("resultants");
  std::vector<std::string> known;
  for (const plate::BeamSection& beam : scene.beams) known.push_back(beam.group);
  for (const plate::ShellSection& shell : scene.sections) known.push_back(shell.group);
  for (const plate::SolidSection& solid : scene.solids) known.push_back(solid.group);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (!contains(known, groups[i]))
      table.refuse_element("resultants", i, no_such_name("group of elements", groups[i], known));
    if (std::find(groups.begin(), groups.begin() + i, groups[i]) != groups.begin() + i)
      table.refuse_element("resultants", i, "is named twice");
  }
  ResultantChoice choice{.groups = std::move(groups), .elements = {}};
  if (table.has("resultant_elements")) {
    choice.elements = table.integers("resultant_elements");
    if (choice.elements.empty()) table.refuse("resultant_elements", "must name an element");
  }
  return choice;
}

PictureChoice read_pictures(const Table& root)
{
  const std::optional<Table> table = optional_table(root);
  if (!table || !table->has("pictures")) return PictureChoice::vertices;
  return table->choice<PictureChoice>("pictures", {{"vertices", PictureChoice::vertices},
                                                   {"all", PictureChoice::all},
                                                   {"none", PictureChoice::none}});
}

bool read_mass_integrals(const Table& root)
{
  const std::optional<Table> table = optional_table(root);
  return !table || !table->has("mass_integrals") || table->truth("mass_integrals");
}

std::vector<std::string> read_stiffening(const Table& root, const Scene& scene)
{
  const std::optional<Table> table = optional_table(root);
  if (!table || !table->has("stiffening")) return {};
  if (const Table mesh = root.table("mesh"); finds_sectors(mesh) || read_sectors(mesh) > 1) {
    table->refuse("stiffening",
                  "is not available for bodies of equal sectors; take one of the two out");
  }
  for (const int c : {0, 1, 2}) {
    if (std::ranges::find(scene.components, c) == scene.components.end()) {
      table->refuse("stiffening",
                    "needs x, y and z in model.dofs: without them the inertia stretches nothing");
    }
  }
  static const std::vector<std::string> known{
      "spin-x", "spin-y", "spin-z", "spin", "angular-acceleration", "acceleration"};
  std::vector<std::string> motions = table->texts("stiffening");
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (!contains(known, motions[i]))
      table->refuse_element("stiffening", i, "must be one of " + quoted_list(known));
    if (std::find(motions.begin(), motions.begin() + i, motions[i]) != motions.begin() + i)
      table->refuse_element("stiffening", i, "is named twice");
  }
  return motions;
}

std::optional<bool> read_sylvester(const Table& root)
{
  const std::optional<Table> table = optional_table(root);
  if (!table || !table->has("sylvester")) return std::nullopt;
  return table->truth("sylvester");
}

namespace {

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
