#include "scene/changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "scene/parse_values.hpp"

namespace chladni::scene {

namespace {

/// The values of a scene by their paths, as text that is equal where they are.
using Values = std::map<std::string, std::string>;

std::string text_of(const toml::node& value)
{
  if (const auto number = value.value<double>()) return fmt::format("{}", *number);
  if (const auto truth = value.value_exact<bool>()) return *truth ? "true" : "false";
  if (const auto text = value.value<std::string>()) return fmt::format("\"{}\"", *text);
  return "?";
}

void collect(const toml::node& node, const std::string& path, Values& values)
{
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      collect(value, path.empty() ? std::string(key.str()) : fmt::format("{}.{}", path, key.str()),
              values);
    }
  } else if (const toml::array* list = node.as_array()) {
    for (std::size_t i = 0; i < list->size(); ++i)
      collect(*list->get(i), list->size() == 1 ? path : fmt::format("{}[{}]", path, i + 1), values);
  } else {
    values.emplace(path, text_of(node));
  }
}

std::optional<toml::table> parsed(const std::string& text)
{
  try {
    return parse_values(text);
  } catch (const std::exception&) {  // what a file calls its scene may be anything
    return std::nullopt;
  }
}

/// Whether one of the texts lets the reduction depend on a key of [body]: a tolerance and the mixed
/// interface on the supports, modes of the whole model on the loads.
bool is_of_reduction(std::string_view key, const Values& values)
{
  const auto has = [&](std::string_view wanted) { return values.contains(std::string(wanted)); };
  if (key == "body.fixed" || key.starts_with("body.fixed[")) {
    const auto method = values.find("reduce.method");
    return has("reduce.tolerance") ||
           (method != values.end() && method->second == "\"mixed-interface\"");
  }
  if (!key.starts_with("body.interface_modes")) return false;
  for (const auto& [path, value] : values) {
    const bool is_space = path.starts_with("body.interface_modes") && path.ends_with(".space");
    if (is_space && value == "\"full\"") return true;
  }
  return false;
}

/// Whether a key of [sound] says what radiates into which air, and not what is listened to.
bool is_of_radiation(std::string_view key)
{
  static constexpr std::array keys{"sound.microphones", "sound.cycle", "sound.harmonics",
                                   "sound.speeds_rad_s", "sound.wav"};
  const bool is_of_sound = key == "sound" || key.starts_with("sound.");
  return is_of_sound &&
         std::ranges::none_of(keys, [&](std::string_view one) { return key.starts_with(one); });
}

bool is_damped_by_sound(const Values& values)
{
  const auto found = values.find("squeal.radiation");
  return found != values.end() && found->second == "true";
}

bool is_of_assembly(std::string_view table)
{
  return table == "part" || table == "joint" || table == "contact";
}

bool is_of(Step step, std::string_view key, const Values& values)
{
  const std::string_view table = key.substr(0, key.find_first_of(".["));
  switch (step) {
    case Step::body:
      return table == "body";
    case Step::squeal:
      return table == "squeal" || is_of_assembly(table) ||
             (is_damped_by_sound(values) && is_of_radiation(key));
    case Step::radiation:
      return is_of_radiation(key);
    case Step::sound:
      return table == "sound";
    case Step::reduction:
      break;
  }
  static const std::set<std::string_view> others{
      "name", "title", "body", "squeal", "sound", "static", "modes", "support", "load", "response"};
  return (!others.contains(table) && !is_of_assembly(table)) || is_of_reduction(key, values);
}

Values values_of(Step step, const toml::table& scene)
{
  Values all, some;
  collect(scene, "", all);
  for (const auto& [key, value] : all)
    if (is_of(step, key, all)) some.emplace(key, value);
  return some;
}

}  // namespace

std::vector<std::string> changed_keys(const std::string& then, const std::string& now, Step step)
{
  const std::optional<toml::table> before = parsed(then), after = parsed(now);
  if (!before || !after) return {};
  const Values old_values = values_of(step, *before), new_values = values_of(step, *after);
  const bool is_of_sound = step == Step::radiation || step == Step::sound;
  const char* of_step = step == Step::squeal ? "squeal" : is_of_sound ? "sound" : "mesh";
  if (!before->contains(of_step) || !after->contains(of_step)) return {};
  std::vector<std::string> changes;
  for (const auto& [key, value] : new_values) {
    const auto old = old_values.find(key);
    if (old == old_values.end())
      changes.push_back(fmt::format("{} = {} (was not there)", key, value));
    else if (old->second != value)
      changes.push_back(fmt::format("{} = {} (was {})", key, value, old->second));
  }
  for (const auto& [key, value] : old_values)
    if (!new_values.contains(key))
      changes.push_back(fmt::format("{} is gone (was {})", key, value));
  return changes;
}

}  // namespace chladni::scene
