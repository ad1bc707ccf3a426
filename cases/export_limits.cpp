#include "cases/export_limits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "common/error.hpp"
#include "plate/plate_options.hpp"
#include "report/text_table.hpp"

namespace chladni::cases {
namespace {

using mbs_export::Damping;

/// The constants of a spring that a key of `[[spring]]` names.
const std::array<double, 6>& constants(const plate::Spring& spring, std::string_view key)
{
  return key == "damping" ? spring.damping : spring.stiffness;
}

/// `key` is "damping" or "stiffness".
[[noreturn]] void refuse_springs(const scene::Scene& scene, const std::string& key,
                                 const std::string& why)
{
  std::string first, places;
  for (std::size_t i = 0; i < scene.springs.size(); ++i) {
    const plate::Spring& spring = scene.springs[i];
    if (spring.to || constants(spring, key) == std::array<double, 6>{}) continue;
    if (first.empty()) first = fmt::format("spring[{}].{}", i + 1, key);
    places += fmt::format("{}\"{}\"", places.empty() ? "" : ", ", spring.at);
  }
  if (!first.empty()) scene::refuse_key(scene, first, fmt::format("at {}: {}", places, why));
  throw Error(
      fmt::format("{}: {} (the scene has none now, but its reduced system has; reduce it "
                  "again)",
                  scene.path, why));
}

}  // namespace

void refuse_export(const scene::Scene& scene, const mbs_export::formats::ExportError& error)
{
  constexpr std::string_view springs = "spring.";
  if (error.key().starts_with(springs))
    refuse_springs(scene, error.key().substr(springs.size()), error.why());
  scene::refuse_key(scene, error.key(), error.why());
}

void refuse_condensed(const mbs_export::ModalBody& body, const std::string& file)
{
  if (!body.condensation) return;
  throw Error(fmt::format(
      "{}: is condensed for the vibrations of one brake, \"{}\", and has no other motions; "
      "export the body that it was made of",
      file, report::printable(body.condensation->brake)));
}

std::vector<std::string> damping_left_out(const std::string& format, const Damping& damping,
                                          int n_free_rigid)
{
  const bool of_reduced_system = format.starts_with("nastran") || format == "matrix-market";
  const bool is_chosen = damping.type != Damping::Type::none;
  if (of_reduced_system && is_chosen && damping.type != Damping::Type::matrix)
    return {
        fmt::format("[body] damping (type = \"{}\") is left out: a reduced system has the "
                    "dampers of the model alone",
                    name_of(damping.type))};
  if (format == "exudyn" && is_chosen)
    return {
        fmt::format("[body] damping (type = \"{}\") is left out: Exudyn's dictionary has no "
                    "damping",
                    name_of(damping.type))};
  const bool slows_rigid_motion = damping.type == Damping::Type::rayleigh && damping.alpha > 0.0;
  if (!of_reduced_system && slows_rigid_motion && n_free_rigid > 0)
    return {
        "[body] damping.alpha is left out for the rigid motion: the file has damping for "
        "elastic modes alone"};
  return {};
}

std::vector<std::string> with_stiffening_left_out(
    std::vector<std::string> notes, const std::string& format,
    const std::optional<mbs_export::Stiffening>& there,
    const std::optional<mbs_export::Stiffening>& written)
{
  if (!there) return notes;
  constexpr std::array<std::string_view, 2> with_a_place{"mbdyn-develop", "sid"};
  if (std::ranges::find(with_a_place, format) == with_a_place.end()) {
    notes.push_back(fmt::format(
        "the geometric stiffening is left out: {} has no place for it; --format {} writes it",
        format, fmt::join(with_a_place, ", ")));
  } else if (!written) {
    notes.push_back(
        fmt::format("the geometric stiffening is left out: the reduced system has that of fixed = "
                    "[{}]; reduce the scene again to have it for this support",
                    fmt::join(there->fixed, ", ")));
  }
  return notes;
}

}  // namespace chladni::cases
