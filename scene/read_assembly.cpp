#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "scene/readers.hpp"

namespace chladni::scene {
namespace {

using squeal::AssemblyOptions;
using squeal::FaceQuantity;
using squeal::PartNodes;

std::vector<std::string> part_names(const AssemblyOptions& options)
{
  std::vector<std::string> names;
  for (const squeal::PartOptions& part : options.parts) names.push_back(part.name);
  return names;
}

squeal::PartOptions read_part(const Table& table, const AssemblyOptions& so_far)
{
  squeal::PartOptions part{.name = table.text("name"), .body = table.text("body")};
  if (part.name.find_first_of("/\\") != std::string::npos)
    table.refuse("name", "must be a name without a slash: it becomes that of a file");
  if (part.name.empty() || part.name.find('.') != std::string::npos || part.name == "ground")
    table.refuse("name", "must be a name without a point, and not \"ground\"");
  if (contains(part_names(so_far), part.name))
    table.refuse("name", "is the name of another part too");
  if (part.body.empty()) table.refuse("body", "must name a file, as in \"pad.body.h5\"");
  if (table.has("position")) part.position = read_vector(table, "position");
  if (table.has("rotation_deg")) part.rotation = read_vector(table, "rotation_deg");
  for (double& angle : part.rotation) angle *= std::numbers::pi / 180.0;
  return part;
}

/// "PART.SET", whose part is one of the scene's and does not turn.
PartNodes read_nodes(const Table& table, std::string_view key, const std::string& value,
                     const AssemblyOptions& options)
{
  const auto point = value.find('.');
  if (point == std::string::npos || point + 1 == value.size())
    table.refuse(key, "must name nodes as \"PART.SET\", as in \"pad.lining\"");
  const PartNodes nodes{.part = value.substr(0, point), .set = value.substr(point + 1)};
  const std::vector<std::string> names = part_names(options);
  if (!contains(names, nodes.part)) table.refuse(key, no_such_name("part", nodes.part, names));
  if (nodes.part == options.disc) {
    table.refuse(key, fmt::format("is part of \"{}\", which turns: it meets others at the faces of "
                                  "[[contact]] alone",
                                  options.disc));
  }
  return nodes;
}

std::array<PartNodes, 2> read_ends(const Table& table, const AssemblyOptions& options)
{
  std::vector<std::string> ends = table.texts("between");
  if (ends.size() != 2)
    table.refuse("between", "must name two ends, as in [\"pad.ear\", \"ground\"]");
  if (ends[0] == "ground") std::swap(ends[0], ends[1]);
  if (ends[0] == "ground") table.refuse("between", "names the ground twice");
  const PartNodes first = read_nodes(table, "between", ends[0], options);
  if (ends[1] == "ground") return {first, PartNodes{}};
  const PartNodes second = read_nodes(table, "between", ends[1], options);
  if (first.part == second.part)
    table.refuse("between", "must name two parts, or one and the ground");
  return {first, second};
}

squeal::JointOptions read_joint(const Table& table, const AssemblyOptions& options)
{
  enum class Type { spring, rigid };
  squeal::JointOptions joint{.ends = read_ends(table, options), .rigid = {}};
  if (table.has("span")) joint.span = table.number("span");
  if (table.choice<Type>("type", {{"spring", Type::spring}, {"rigid", Type::rigid}}) ==
      Type::rigid) {
    joint.rigid = {0, 1, 2, 3, 4, 5};
    joint.spares_drilling = !table.has("dofs");
    if (!joint.spares_drilling) joint.rigid = read_component_list(table, "dofs");
    return joint;
  }
  joint.stiffness = read_by_component(table, "stiffness");
  if (table.has("damping")) joint.damping = read_by_component(table, "damping");
  if (std::ranges::all_of(joint.stiffness, [](double k) { return k == 0.0; }))
    table.refuse("stiffness", "must name a direction: x, y, z, rx, ry or rz");
  return joint;
}

/// One of two keys, of the whole face and of each square metre.
FaceQuantity read_quantity(const Table& table, std::string_view whole, std::string_view per_area)
{
  const std::string_view key = table.only_one_of({whole, per_area});
  return {.value = table.number(key), .per_area = key == per_area};
}

squeal::FaceContact read_face(const Table& table, const AssemblyOptions& options)
{
  using squeal::NodeShares;
  squeal::FaceContact contact{.face = read_nodes(table, "face", table.text("face"), options),
                              .height = table.number("height"),
                              .stiffness = read_quantity(table, "stiffness", "stiffness_per_area"),
                              .preload = read_quantity(table, "preload", "pressure")};
  if (table.has("damping") || table.has("damping_per_area"))
    contact.damping = read_quantity(table, "damping", "damping_per_area");
  if (table.has("shares")) {
    contact.shares = table.choice<NodeShares>(
        "shares", {{"by area", NodeShares::by_area}, {"equal", NodeShares::equal}});
  }
  if (table.has("friction")) contact.friction = read_friction(table);
  return contact;
}

/// Rings and contact planes of the disc.
void read_disc(AssemblyOptions& options, const Table& squeal)
{
  options.disc = squeal.text("disc");
  const std::vector<std::string> names = part_names(options);
  if (!contains(names, options.disc))
    squeal.refuse("disc", no_such_name("part", options.disc, names));
  options.rings = squeal.texts("rings");
  if (options.rings.empty()) squeal.refuse("rings", "must name at least one ring of the disc");
  for (auto ring = options.rings.begin(); ring != options.rings.end(); ++ring)
    if (std::find(options.rings.begin(), ring, *ring) != ring)
      squeal.refuse("rings", fmt::format("names \"{}\" twice", *ring));
  if (squeal.only_one_of({"thickness", "contact_planes"}) == "thickness") {
    options.thickness = squeal.number("thickness");
  } else {
    const std::vector<double> z = squeal.numbers("contact_planes");
    if (z.size() != 2 || !(z[1] > z[0]))
      squeal.refuse("contact_planes", "must be [z of the lower plane, z of the upper one], in m");
    options.planes = {z[0], z[1]};
    options.thickness = z[1] - z[0];
  }
  if (squeal.has("slopes_from")) options.slopes_from = squeal.texts("slopes_from");
  if (squeal.has("convection"))
    options.convection = squeal.choice<bool>("convection", {{"kept", true}, {"left out", false}});
}

}  // namespace

AssemblyOptions read_assembly(const Table& root)
{
  AssemblyOptions options{};
  for (const Table& table : root.tables("part")) options.parts.push_back(read_part(table, options));
  const Table squeal = root.table("squeal");
  read_disc(options, squeal);
  for (std::size_t i = 0; i < options.parts.size(); ++i) {
    const Table table = root.tables("part")[i];
    for (const char* key : {"position", "rotation_deg"})
      if (options.parts[i].name == options.disc && table.has(key))
        table.refuse(key, "is that of the disc, which turns about the z axis of its own mesh");
  }
  if (root.has("joint"))
    for (const Table& table : root.tables("joint"))
      options.joints.push_back(read_joint(table, options));
  for (const Table& table : root.tables("contact"))
    options.contacts.push_back(read_face(table, options));
  if (options.contacts.empty()) root.refuse("contact", "must hold at least one lining");
  options.friction = read_friction(squeal);
  return options;
}

}  // namespace chladni::scene
