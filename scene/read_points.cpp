#include "scene/read_tables.hpp"

namespace chladni::scene {
namespace {

/// Groups, rings and couplings; groups of a mesh file are known once it is read.
std::string read_place(const Table& table, std::string_view key, const Scene& scene)
{
  const std::string name = table.text(key);
  std::vector<std::string> names = group_names(scene);
  if (names.empty()) return name;
  for (const plate::Coupling& coupling : scene.couplings)
    if (!coupling.name.empty()) names.push_back(coupling.name);
  if (!contains(names, name)) table.refuse(key, no_such_name("group or coupling", name, names));
  return name;
}

/// The symmetric tensor about the centre of mass, or three moments.
std::array<double, 6> read_inertia(const Table& mass)
{
  const std::vector<double> values = mass.numbers("inertia");
  if (values.size() != 3 && values.size() != 6)
    mass.refuse("inertia", "must be three moments [xx, yy, zz] or six [xx, yy, zz, xy, xz, yz]");
  std::array<double, 6> inertia{};
  std::ranges::copy(values, inertia.begin());
  const auto [xx, yy, zz, xy, xz, yz] = inertia;
  const double minor = xx * yy - xy * xy;
  const double det = zz * minor - xx * yz * yz - yy * xz * xz + 2.0 * xy * xz * yz;
  const double round_off = 1e-12 * (xx + yy + zz);
  const bool semidefinite =
      xx >= 0.0 && yy >= 0.0 && zz >= 0.0 && minor >= -round_off * (xx + yy) &&
      xx * zz - xz * xz >= -round_off * (xx + zz) && yy * zz - yz * yz >= -round_off * (yy + zz) &&
      det >= -round_off * (xx + yy + zz) * (xx + yy + zz);
  if (!semidefinite || xx + yy < zz - round_off || yy + zz < xx - round_off ||
      zz + xx < yy - round_off) {
    mass.refuse("inertia",
                "no rigid body has these moments: none is negative or exceeds the sum of the "
                "other two, and xy = -int x y dm are not too large");
  }
  return inertia;
}

}  // namespace

plate::PointMass read_mass(const Table& table, const Scene& scene)
{
  plate::PointMass mass{.at = read_place(table, "at", scene), .mass = table.number("mass")};
  if (table.has("inertia")) mass.inertia = read_inertia(table);
  if (table.has("offset")) mass.offset = read_vector(table, "offset");
  return mass;
}

plate::Spring read_spring(const Table& table, const Scene& scene)
{
  plate::Spring spring{.at = read_place(table, "at", scene)};
  if (table.has("to")) {
    spring.to = read_place(table, "to", scene);
    if (*spring.to == spring.at) table.refuse("to", "is the place where the spring begins");
  }
  if (!table.has("stiffness") && !table.has("damping"))
    table.refuse("at", "the spring needs `stiffness` or `damping`, like { z = 1e6 }");
  if (table.has("stiffness")) spring.stiffness = read_by_component(table, "stiffness");
  if (table.has("damping")) spring.damping = read_by_component(table, "damping");
  if (table.has("loss_factor")) {
    if (!table.has("stiffness"))
      table.refuse("loss_factor", "is that of the stiffness; give `stiffness`, or `damping` alone");
    spring.loss_factor = table.number("loss_factor");
  }
  return spring;
}

std::vector<plate::PointMass> read_masses(const Table& root, const Scene& scene)
{
  std::vector<plate::PointMass> masses;
  if (!root.has("mass")) return masses;
  for (const Table& table : root.tables("mass")) masses.push_back(read_mass(table, scene));
  return masses;
}

std::vector<plate::Spring> read_springs(const Table& root, const Scene& scene)
{
  std::vector<plate::Spring> springs;
  if (!root.has("spring")) return springs;
  for (const Table& table : root.tables("spring")) springs.push_back(read_spring(table, scene));
  return springs;
}

}  // namespace chladni::scene
