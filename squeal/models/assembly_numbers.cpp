#include "squeal/models/assembly_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <string_view>
#include <utility>

#include "squeal/models/friction_numbers.hpp"

namespace chladni::squeal {
namespace {

/// Steps of places (m) and of angles (degrees).
constexpr double step_of_place = 1e-6, step_of_angle = 1e-4;

constexpr std::array<std::string_view, 6> component_keys{"x", "y", "z", "rx", "ry", "rz"};

void add_places(std::vector<AssemblyNumber>& numbers, const AssemblyOptions& options, std::size_t i)
{
  constexpr double degree = std::numbers::pi / 180.0;
  const PartOptions& part = options.parts[i];
  for (std::size_t c = 0; c < 3; ++c) {
    numbers.push_back(
        {.key = fmt::format("part[{}].position[{}]", i + 1, c + 1),
         .unit = "m",
         .value = part.position[c],
         .step = step_of_place,
         .set = [i, c](AssemblyOptions& o, double x) { o.parts[i].position[c] = x; }});
  }
  for (std::size_t c = 0; c < 3; ++c) {
    numbers.push_back(
        {.key = fmt::format("part[{}].rotation_deg[{}]", i + 1, c + 1),
         .unit = "degrees",
         .value = part.rotation[c] / degree,
         .step = step_of_angle,
         .set = [i, c](AssemblyOptions& o, double x) { o.parts[i].rotation[c] = degree * x; }});
  }
}

void add_joint(std::vector<AssemblyNumber>& numbers, const JointOptions& joint, std::size_t i)
{
  for (std::size_t c = 0; c < component_keys.size(); ++c) {
    if (!(joint.stiffness[c] > 0.0)) continue;
    numbers.push_back(
        {.key = fmt::format("joint[{}].stiffness.{}", i + 1, component_keys[c]),
         .unit = c < 3 ? "N/m" : "N m",
         .value = joint.stiffness[c],
         .step = 0.0,
         .set = [i, c](AssemblyOptions& o, double x) { o.joints[i].stiffness[c] = x; }});
  }
  for (std::size_t c = 0; c < component_keys.size(); ++c) {
    if (!(joint.damping[c] > 0.0)) continue;
    numbers.push_back(
        {.key = fmt::format("joint[{}].damping.{}", i + 1, component_keys[c]),
         .unit = c < 3 ? "N s/m" : "N m s",
         .value = joint.damping[c],
         .step = 0.0,
         .set = [i, c](AssemblyOptions& o, double x) { o.joints[i].damping[c] = x; }});
  }
}

/// A property of a face: its two keys, of the whole face and of each square metre, and their units.
struct FaceRow {
  FaceQuantity FaceContact::*quantity;
  std::string_view whole, whole_unit, per_area, per_area_unit;
};

constexpr std::array rows_of_face{
    FaceRow{&FaceContact::stiffness, "stiffness", "N/m", "stiffness_per_area", "N/m^3"},
    FaceRow{&FaceContact::damping, "damping", "N s/m", "damping_per_area", "N s/m^3"},
    FaceRow{&FaceContact::preload, "preload", "N", "pressure", "Pa"}};

void add_contact(std::vector<AssemblyNumber>& numbers, const FaceContact& contact, std::size_t i)
{
  const std::string key = fmt::format("contact[{}]", i + 1);
  numbers.push_back({.key = key + ".height",
                     .unit = "m",
                     .value = contact.height,
                     .step = 0.0,
                     .set = [i](AssemblyOptions& o, double x) { o.contacts[i].height = x; }});
  for (const FaceRow& row : rows_of_face) {
    const FaceQuantity& quantity = contact.*(row.quantity);
    if (!(quantity.value > 0.0)) continue;
    numbers.push_back(
        {.key = fmt::format("{}.{}", key, quantity.per_area ? row.per_area : row.whole),
         .unit = std::string(quantity.per_area ? row.per_area_unit : row.whole_unit),
         .value = quantity.value,
         .step = 0.0,
         .set = [i, at = row.quantity](AssemblyOptions& o, double x) {
           (o.contacts[i].*at).value = x;
         }});
  }
  if (!contact.friction) return;
  for (FrictionNumber& number : friction_numbers(*contact.friction, key + ".friction")) {
    numbers.push_back({.key = std::move(number.key),
                       .unit = std::string(number.unit),
                       .value = number.value,
                       .step = number.step,
                       .set = [i, with = std::move(number.with)](AssemblyOptions& o, double x) {
                         o.contacts[i].friction = with(x);
                       }});
  }
}

void add_disc(std::vector<AssemblyNumber>& numbers, const AssemblyOptions& options)
{
  if (!options.planes) {
    numbers.push_back({.key = "thickness",
                       .unit = "m",
                       .value = options.thickness,
                       .step = 0.0,
                       .set = [](AssemblyOptions& o, double x) { o.thickness = x; }});
  } else {
    for (std::size_t side = 0; side < 2; ++side) {
      numbers.push_back({.key = fmt::format("contact_planes[{}]", side + 1),
                         .unit = "m",
                         .value = (*options.planes)[side],
                         .step = step_of_place,
                         .set = [side](AssemblyOptions& o, double x) {
                           (*o.planes)[side] = x;
                           o.thickness = (*o.planes)[1] - (*o.planes)[0];
                         }});
    }
  }
  const auto has_its_own = [](const FaceContact& contact) { return contact.friction.has_value(); };
  if (std::ranges::all_of(options.contacts, has_its_own)) return;
  for (FrictionNumber& number : friction_points(options.friction, "friction")) {
    numbers.push_back({.key = std::move(number.key),
                       .unit = std::string(number.unit),
                       .value = number.value,
                       .step = number.step,
                       .set = [with = std::move(number.with)](AssemblyOptions& o, double x) {
                         o.friction = with(x);
                       }});
  }
}

}  // namespace

std::vector<AssemblyNumber> assembly_numbers(const AssemblyOptions& options)
{
  std::vector<AssemblyNumber> numbers;
  for (std::size_t i = 0; i < options.parts.size(); ++i)
    if (options.parts[i].name != options.disc) add_places(numbers, options, i);
  for (std::size_t i = 0; i < options.joints.size(); ++i) add_joint(numbers, options.joints[i], i);
  for (std::size_t i = 0; i < options.contacts.size(); ++i)
    add_contact(numbers, options.contacts[i], i);
  add_disc(numbers, options);
  return numbers;
}

}  // namespace chladni::squeal
