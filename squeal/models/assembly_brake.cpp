#include "squeal/models/assembly_brake.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "common/error.hpp"
#include "squeal/models/friction_parameters.hpp"

namespace chladni::squeal {
namespace {

struct LiningRow {
  std::string_view name;
  double Lining::*value;
};

constexpr std::array lining_rows{LiningRow{"preload", &Lining::preload},
                                 LiningRow{"stiffness", &Lining::stiffness},
                                 LiningRow{"damping", &Lining::damping}};

/// A face whose friction is that of the brake; null where each has its own.
const Lining* first_of_brake(const std::vector<Lining>& linings)
{
  const auto found = std::ranges::find(linings, false, &Lining::has_own_friction);
  return found == linings.end() ? nullptr : &*found;
}

/// Whether all linings have one value, up to the rounding of areas.
bool is_shared(const std::vector<Lining>& linings, double Lining::*value)
{
  constexpr double rounding = 1e-9;
  const double first = linings.front().*value;
  return std::ranges::all_of(linings, [&](const Lining& lining) {
    return std::abs(lining.*value - first) <= rounding * std::abs(first);
  });
}

/// Says what `gradients` leaves out.
Assembly with_notes(Assembly assembly)
{
  std::vector<std::string_view> own;
  for (const LiningRow& row : lining_rows)
    if (!is_shared(assembly.linings, row.value)) own.push_back(row.name);
  if (!own.empty()) {
    assembly.notes.push_back(
        fmt::format("linings differ in {}: gradients leave it out, and a range of it sets the same "
                    "value for all linings",
                    fmt::join(own, " and in ")));
  }
  return assembly;
}

}  // namespace

AssemblyBrake::AssemblyBrake(Assembly assembly)
    : assembly_(std::make_shared<const Assembly>(with_notes(std::move(assembly)))),
      linings_(assembly_->linings)
{}

Eigen::MatrixXd AssemblyBrake::state_matrix(double speed) const
{
  return squeal::state_matrix(*assembly_, linings_, speed);
}

std::unique_ptr<Brake> AssemblyBrake::with(MapParameter parameter, double value) const
{
  auto changed = std::make_unique<AssemblyBrake>(*this);
  if (is_of_law(parameter) && first_of_brake(linings_)) {
    for (Lining& lining : changed->linings_)
      if (!lining.has_own_friction)
        lining.friction = with_friction_parameter(lining.friction, parameter, value);
    return changed;
  }
  const auto row = std::ranges::find(lining_rows, parameter.name, &LiningRow::name);
  if (row == lining_rows.end() || parameter.pad != 0) {
    throw Error(fmt::format(
        "[squeal] \"{}\" cannot vary in an assembly, whose parameters are the friction of the "
        "brake, and stiffness, damping and preload of all linings",
        key_of(parameter)));
  }
  for (Lining& lining : changed->linings_) lining.*(row->value) = value;
  return changed;
}

std::vector<ParameterValue> AssemblyBrake::parameters() const
{
  std::vector<ParameterValue> values;
  if (const Lining* lining = first_of_brake(linings_))
    values = friction_parameters(lining->friction);
  for (const LiningRow& row : lining_rows)
    if (is_shared(linings_, row.value)) values.push_back({{row.name}, linings_.front().*row.value});
  return values;
}

std::unique_ptr<AutonomousMotion> AssemblyBrake::motion(double /*speed*/) const
{
  throw Error(
      "squeal.model = \"assembly\" covers small motions about sliding only, without limit cycles; "
      "leave out these analyses");
}

double AssemblyBrake::rest_compression() const
{
  return linings_.front().preload / linings_.front().stiffness;
}

}  // namespace chladni::squeal
