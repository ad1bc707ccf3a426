#include <algorithm>
#include <iterator>

#include "scene/readers.hpp"

namespace chladni::scene {
namespace {

std::string read_set(const Table& table, const Scene& scene)
{
  const std::string name = table.text("group");
  const std::vector<std::string> names = named_sets(scene);
  if (!names.empty() && !contains(names, name))
    table.refuse("group", no_such_name("group, ring or coupling", name, names));
  return name;
}

/// In the plane of symmetry nothing moves along its normal or turns about its axes.
std::vector<int> symmetry_components(const Table& support)
{
  const int n = support.choice<int>("normal", {{"x", 0}, {"y", 1}, {"z", 2}});
  return {n, 3 + (n + 1) % 3, 3 + (n + 2) % 3};
}

std::vector<int> components_of(const Table& support)
{
  if (support.only_one_of({"type", "dofs"}) == "dofs") return read_component_list(support, "dofs");
  enum class Type { clamped, simply_supported, symmetry };
  switch (support.choice<Type>("type", {{"clamped", Type::clamped},
                                        {"simply-supported", Type::simply_supported},
                                        {"symmetry", Type::symmetry}})) {
    case Type::clamped:
      return {0, 1, 2, 3, 4, 5};
    case Type::simply_supported:
      return {0, 1, 2};
    case Type::symmetry:
      break;
  }
  return symmetry_components(support);
}

plate::NodalLoad read_nodal_load(const Table& table, const Scene& scene)
{
  plate::NodalLoad load{.group = read_set(table, scene)};
  const bool has_force = table.has("force");
  const bool has_moment = table.has("moment");
  if (has_force || !has_moment) load.force = read_vector(table, "force");
  if (has_moment) load.moment = read_vector(table, "moment");
  return load;
}

enum class LoadType { force, line, pressure, gravity };

plate::Load read_load(const Table& table, const Scene& scene)
{
  switch (table.choice<LoadType>("type", {{"force", LoadType::force},
                                          {"line", LoadType::line},
                                          {"pressure", LoadType::pressure},
                                          {"gravity", LoadType::gravity}})) {
    case LoadType::force:
      return read_nodal_load(table, scene);
    case LoadType::line:
      return plate::EdgeLoad{.group = read_set(table, scene),
                             .line_force = read_vector(table, "line_force")};
    case LoadType::pressure:
      return plate::PressureLoad{.group = read_set(table, scene),
                                 .pressure = table.number("pressure")};
    case LoadType::gravity:
      break;
  }
  return plate::GravityLoad{.acceleration = read_vector(table, "acceleration")};
}

}  // namespace

std::vector<std::string> named_sets(const Scene& scene)
{
  std::vector<std::string> names = group_names(scene);
  if (names.empty()) return names;
  for (const plate::Coupling& coupling : scene.couplings)
    if (!coupling.name.empty()) names.push_back(coupling.name);
  return names;
}

std::vector<plate::Support> read_supports(const Table& root, const Scene& scene)
{
  std::vector<plate::Support> supports;
  if (!root.has("support")) return supports;
  for (const Table& table : root.tables("support"))
    supports.push_back({.group = read_set(table, scene), .components = components_of(table)});
  return supports;
}

std::vector<plate::Load> read_loads(const Table& root, const Scene& scene)
{
  std::vector<plate::Load> loads;
  if (!root.has("load")) return loads;
  for (const Table& table : root.tables("load")) loads.push_back(read_load(table, scene));
  return loads;
}

std::optional<StaticOptions> read_static(const Table& root, const Scene& scene)
{
  if (!root.has("static")) return std::nullopt;
  const Table table = root.table("static");
  StaticOptions options;
  if (!table.has("report")) return options;
  options.report = table.texts("report");
  const std::vector<std::string> names = named_sets(scene);
  for (std::size_t i = 0; i < options.report.size(); ++i) {
    if (names.empty() || contains(names, options.report[i])) continue;
    table.refuse_element("report", i,
                         no_such_name("group, ring or coupling", options.report[i], names));
  }
  return options;
}

std::optional<ModesOptions> read_natural_modes(const Table& root)
{
  if (!root.has("modes")) return std::nullopt;
  const Table table = root.table("modes");
  ModesOptions options;
  if (table.has("count")) options.count = table.integer("count");
  if (table.has("mesh_errors")) options.mesh_errors = table.truth("mesh_errors");
  return options;
}

}  // namespace chladni::scene
