#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "scene/readers.hpp"
#include "squeal/cycle/cycle_harmonics.hpp"

namespace chladni::scene {
namespace {

using Eigen::Vector2d;
using sound::MidLine;

/// "[sound] needs `outline`", because of the mesh or the section.
[[noreturn]] void refuse_without_outline(const Table& root, const std::string& why)
{
  root.refuse("sound", why +
                           "; give the middle surface in the key outline = [{ from = [r, z], to "
                           "= [r, z], thickness = t }, ...]");
}

double thickness_of(const Table& root, const Scene& scene, const std::string& group)
{
  for (const plate::ShellSection& section : scene.sections) {
    if (section.group != group) continue;
    if (section.thickness.at.empty()) return section.thickness.values.front();
    refuse_without_outline(root, fmt::format("the thickness of \"{}\" is not constant", group));
  }
  refuse_without_outline(root, fmt::format("the group \"{}\" has no section", group));
}

/// The middle surface of a generated disc.
std::vector<MidLine> generated_lines(const Table& root, const Scene& scene)
{
  const auto line = [&](const Vector2d& from, const Vector2d& to, const char* group) {
    return MidLine{.from = from, .to = to, .thickness = thickness_of(root, scene, group)};
  };
  if (const auto& disc = scene.mesh.annulus; disc && scene.mesh.extrude) {
    const auto& [from, to, layers] = *scene.mesh.extrude;
    const double middle = 0.5 * (from + to);
    return {{.from = {disc->inner_radius, middle},
             .to = {disc->outer_radius, middle},
             .thickness = to - from}};
  }
  if (const auto& disc = scene.mesh.annulus)
    return {line({disc->inner_radius, 0.0}, {disc->outer_radius, 0.0}, "disc")};
  if (const auto& hat = scene.mesh.hat_disc) {
    return {
        line({hat->inner_radius, 0.0}, {hat->outer_radius, 0.0}, "disc"),
        line({hat->wall_radius, hat->foot}, {hat->top_radius, hat->height}, "wall"),
        line({hat->hub_radius, hat->height}, {hat->top_radius, hat->height}, "flange"),
    };
  }
  refuse_without_outline(root,
                         "only the generators annulus and hat_disc know the shape of their body");
}

Vector2d read_point(const Table& table, std::string_view key)
{
  const std::vector<double> x = table.numbers(key);
  if (x.size() != 2 || x[0] < 0.0) table.refuse(key, "must be [r, z] in m with r >= 0");
  return {x[0], x[1]};
}

std::vector<MidLine> read_lines(const Table& root, const Table& sound, const Scene& scene)
{
  if (!sound.has("outline")) return generated_lines(root, scene);
  std::vector<MidLine> lines;
  for (const Table& piece : sound.tables("outline")) {
    lines.push_back({.from = read_point(piece, "from"),
                     .to = read_point(piece, "to"),
                     .thickness = piece.number("thickness")});
    if (lines.back().length() == 0.0) piece.refuse("to", "must differ from `from`");
  }
  if (lines.empty()) sound.refuse("outline", "must hold at least one piece");
  return lines;
}

std::vector<sound::Holes> read_holes(const Table& sound)
{
  std::vector<sound::Holes> all;
  if (!sound.has("holes")) return all;
  for (const Table& table : sound.tables("holes")) {
    sound::Holes holes{.circle_radius = table.number("circle_radius"),
                       .radius = table.number("radius"),
                       .count = table.integer("count")};
    if (table.has("angle_deg")) holes.angle = table.number("angle_deg") * std::numbers::pi / 180.0;
    all.push_back(holes);
  }
  return all;
}

std::vector<sound::Microphone> read_microphones(const Table& sound)
{
  std::vector<sound::Microphone> microphones;
  if (!sound.has("microphones")) return microphones;
  for (const Table& table : sound.tables("microphones")) {
    const auto x = read_vector(table, "position");
    microphones.push_back({table.text("name"), {x[0], x[1], x[2]}});
    const auto same = [&](const auto& other) { return other.name == microphones.back().name; };
    if (std::ranges::count_if(microphones, same) > 1)
      table.refuse("name", "is the name of another microphone, too");
  }
  return microphones;
}

std::optional<double> optional_number(const Table& table, const char* key)
{
  if (!table.has(key)) return std::nullopt;
  return table.number(key);
}

sound::AirOptions read_air(const Table& sound)
{
  sound::AirOptions air;
  if (sound.has("medium")) {
    const Table medium = sound.table("medium");
    air.medium = {.density = medium.number("density"),
                  .speed_of_sound = medium.number("speed_of_sound")};
  }
  if (sound.has("method")) {
    air.method = sound.choice<sound::Method>("method", {{"auto", sound::Method::automatic},
                                                        {"fourier", sound::Method::fourier},
                                                        {"tetrahedra", sound::Method::tetrahedra}});
  }
  if (sound.has("order")) air.order = sound.integer("order");
  air.element_size = optional_number(sound, "element_size");
  air.edge_size = optional_number(sound, "edge_size");
  air.inner_radius = optional_number(sound, "inner_radius");
  air.layer_thickness = optional_number(sound, "layer_thickness");
  air.layer_strength = optional_number(sound, "layer_strength");
  return air;
}

std::optional<sound::WavCase> read_wav(const Table& sound,
                                       const std::vector<sound::Microphone>& microphones)
{
  if (!sound.has("wav")) return std::nullopt;
  const Table table = sound.table("wav");
  sound::WavCase wav{.microphone = table.text("microphone"),
                     .rate_Hz = table.integer("rate_Hz"),
                     .duration = table.number("duration_s")};
  std::vector<std::string> names;
  for (const sound::Microphone& microphone : microphones) names.push_back(microphone.name);
  if (!contains(names, wav.microphone))
    table.refuse("microphone", no_such_name("microphone", wav.microphone, names));
  return wav;
}

}  // namespace

std::optional<sound::SoundOptions> read_sound(const Table& root, const Scene& scene)
{
  if (!root.has("sound")) return std::nullopt;
  const Table sound = root.table("sound");
  if (!scene.squeal) root.refuse("sound", "needs [squeal], which says which modes sound and how");
  sound::SoundOptions options{.air = read_air(sound), .lines = read_lines(root, sound, scene)};
  if (sound.has("hub")) {
    options.hub = sound.choice<sound::Hub>(
        "hub", {{"closed", sound::Hub::closed}, {"open", sound::Hub::open}});
  }
  options.holes = read_holes(sound);
  options.microphones = read_microphones(sound);
  if (sound.has("cycle")) {
    options.cycle =
        sound.choice<sound::CycleChoice>("cycle", {{"auto", sound::CycleChoice::automatic},
                                                   {"transient", sound::CycleChoice::transient},
                                                   {"direct", sound::CycleChoice::direct}});
  }
  if (sound.has("harmonics"))
    options.harmonics = sound.integer("harmonics", {.at_most = double(squeal::n_cycle_harmonics)});
  if (sound.has("speeds_rad_s")) options.speeds = sound.numbers("speeds_rad_s");
  options.wav = read_wav(sound, options.microphones);
  return options;
}

}  // namespace chladni::scene
