#include "squeal/models/assembly_brake.hpp"

#include <algorithm>
#include <array>
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

}  // namespace

AssemblyBrake::AssemblyBrake(Assembly assembly)
    : assembly_(std::make_shared<const Assembly>(std::move(assembly))), linings_(assembly_->linings)
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
  const bool has_it = row != lining_rows.end() && parameter.pad == 0;
  for (Lining& lining : changed->linings_)
    set_parameter(has_it ? &(lining.*(row->value)) : nullptr, parameter, value);
  return changed;
}

std::vector<ParameterValue> AssemblyBrake::parameters() const
{
  std::vector<ParameterValue> values;
  if (const Lining* lining = first_of_brake(linings_))
    values = friction_parameters(lining->friction);
  for (const LiningRow& row : lining_rows) {
    const double first = linings_.front().*row.value;
    if (std::ranges::all_of(linings_, [&](const Lining& l) { return l.*row.value == first; }))
      values.push_back({{row.name}, first});
  }
  return values;
}

std::unique_ptr<AutonomousMotion> AssemblyBrake::motion(double /*speed*/) const
{
  throw Error(
      "squeal.model = \"assembly\" has the small motions about sliding alone, no limit cycles; "
      "leave out these analyses");
}

double AssemblyBrake::rest_compression() const
{
  return linings_.front().preload / linings_.front().stiffness;
}

}  // namespace chladni::squeal
