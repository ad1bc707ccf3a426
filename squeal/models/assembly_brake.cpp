#include "squeal/models/assembly_brake.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string_view>
#include <utility>

#include "common/error.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/models/parameters.hpp"

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

/// Says what a range of a parameter does to linings that differ.
Assembly with_notes(Assembly assembly)
{
  std::vector<std::string_view> own;
  for (const LiningRow& row : lining_rows)
    if (!is_shared(assembly.linings, row.value)) own.push_back(row.name);
  if (!own.empty()) {
    assembly.notes.push_back(
        fmt::format("linings differ in {}: a range of it sets the same value for all linings",
                    fmt::join(own, " and in ")));
  }
  return assembly;
}

/// Whether rigid joints allow a small change of a place to both sides.
bool is_free(const BrakeNumber& place)
{
  try {
    place.with(place.value + place.step);
    place.with(place.value - place.step);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

AssemblyBrake::AssemblyBrake(const AssemblyOptions& options,
                             std::span<const mbs_export::ModalBody> bodies)
    : source_(std::make_shared<const Source>(Source{options, {bodies.begin(), bodies.end()}})),
      assembly_(std::make_shared<const Assembly>(with_notes(squeal::assembly(options, bodies)))),
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

std::vector<BrakeNumber> AssemblyBrake::further_numbers() const
{
  std::vector<BrakeNumber> numbers;
  for (AssemblyNumber& number : assembly_numbers(source_->options)) {
    const bool is_place = number.key.starts_with("part[");
    BrakeNumber found = number_of(std::move(number));
    if (is_place && !is_free(found)) continue;
    numbers.push_back(std::move(found));
  }
  add_frequencies(numbers);
  return numbers;
}

std::unique_ptr<Brake> AssemblyBrake::of(Assembly assembly) const
{
  auto changed = std::make_unique<AssemblyBrake>(*this);
  changed->assembly_ = std::make_shared<const Assembly>(std::move(assembly));
  changed->linings_ = changed->assembly_->linings;
  return changed;
}

BrakeNumber AssemblyBrake::number_of(AssemblyNumber number) const
{
  return {.key = std::move(number.key),
          .unit = std::move(number.unit),
          .value = number.value,
          .step = number.step,
          .with = [this, set = std::move(number.set)](double value) {
            AssemblyOptions options = source_->options;
            set(options, value);
            return of(neighbour(*assembly_, options, source_->bodies));
          }};
}

void AssemblyBrake::add_frequencies(std::vector<BrakeNumber>& numbers) const
{
  for (BrakeNumber& number : disc_frequencies(assembly_->disc, [this](InertialDisc disc) {
         Assembly changed = *assembly_;
         changed.disc = std::move(disc);
         return of(std::move(changed));
       }))
    numbers.push_back(std::move(number));
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < source_->options.parts.size(); ++i) {
    const PartOptions& part = source_->options.parts[i];
    if (part.name == source_->options.disc) continue;
    const Eigen::VectorXd& omega = source_->bodies[i].omega;
    for (Eigen::Index mode = 0; mode < omega.size(); ++mode, ++row)
      if (omega[mode] > 0.0) numbers.push_back(frequency_of(part.name, mode, omega[mode], row));
  }
}

BrakeNumber AssemblyBrake::frequency_of(const std::string& part, Eigen::Index mode, double omega,
                                        Eigen::Index row) const
{
  constexpr double from_Hz = 2.0 * std::numbers::pi;
  return {.key = fmt::format("frequency of mode {} of \"{}\" at {:.6g} Hz", mode + 1, part,
                             omega / from_Hz),
          .unit = "Hz",
          .value = omega / from_Hz,
          .step = 0.0,
          .with =
              [this, row, omega](double f_Hz) {
                Assembly changed = *assembly_;
                const Eigen::RowVectorXd x = changed.X.row(row);
                const double lambda = std::pow(from_Hz * f_Hz, 2) - omega * omega;
                changed.K += lambda * x.transpose() * x;
                return of(std::move(changed));
              },
          .derivative =
              [this, row, omega](double /*speed*/) {
                const Eigen::Index n = assembly_->n_coordinates(), n_b = assembly_->omega.size();
                const Eigen::RowVectorXd x = assembly_->X.row(row);
                const Eigen::RowVectorXd over_scales =
                    x.cwiseQuotient(state_scales(*assembly_).tail(n_b).transpose());
                Eigen::MatrixXd dA = Eigen::MatrixXd::Zero(2 * n, 2 * n);
                dA.block(2 * n - n_b, n - n_b, n_b, n_b) =
                    -2.0 * omega * from_Hz * x.transpose() * over_scales;
                return dA;
              }};
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
                       .step = 0.0,
                       .set = [i, with = std::move(number.with)](AssemblyOptions& o, double x) {
                         o.contacts[i].friction = with(x);
                       }});
  }
}

void add_disc_numbers(std::vector<AssemblyNumber>& numbers, const AssemblyOptions& options)
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
  add_disc_numbers(numbers, options);
  return numbers;
}

}  // namespace chladni::squeal
