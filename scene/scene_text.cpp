#include "scene/scene_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "common/error.hpp"
#include "scene/document.hpp"
#include "scene/keys.hpp"

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

bool is_of_step(Step step, std::string_view key, const Values& values)
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
    if (is_of_step(step, key, all)) some.emplace(key, value);
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

namespace {

constexpr std::string_view of_squeal = "squeal.";

/// The byte at which a place of toml++ begins, whose columns count characters of UTF-8.
std::size_t byte_of(std::string_view text, toml::source_position at)
{
  std::size_t byte = 0;
  for (toml::source_index line = 1; line < at.line; ++line) byte = text.find('\n', byte) + 1;
  const auto continues = [&](std::size_t i) {
    return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  for (toml::source_index column = 1; column < at.column; ++column) {
    ++byte;
    while (continues(byte)) ++byte;
  }
  return byte;
}

NumberPlace place_of(std::string_view text, const toml::node& number, std::string key)
{
  const std::size_t from = byte_of(text, number.source().begin);
  const std::size_t end = text.find_first_of(", \t\r\n]}#", from);
  return {std::move(key), from, std::min(end, text.size())};
}

void collect(std::string_view text, const toml::node& node, const std::string& path,
             std::vector<NumberPlace>& places)
{
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      collect(text, value,
              path.empty() ? std::string(key.str()) : fmt::format("{}.{}", path, key.str()),
              places);
    }
  } else if (const toml::array* list = node.as_array()) {
    for (std::size_t i = 0; i < list->size(); ++i)
      collect(text, *list->get(i), fmt::format("{}[{}]", path, i + 1), places);
  } else if (node.is_number()) {
    places.push_back(place_of(text, node, path));
  }
}

/// Whether the key of one number is `key`, in which places of tables in lists may be left out.
bool is_meant(std::string_view key, std::string_view number)
{
  while (!number.empty()) {
    if (!key.empty() && key.front() == number.front()) {
      key.remove_prefix(1);
      number.remove_prefix(1);
      continue;
    }
    const std::size_t close = number.find("].");
    if (number.front() != '[' || close == std::string_view::npos || key.empty() ||
        key.front() != '.')
      return false;
    number.remove_prefix(close + 1);
  }
  return key.empty();
}

std::string without_places(std::string_view key)
{
  std::string text;
  bool is_within = false;
  for (const char c : key) {
    is_within = c == '[' || (is_within && c != ']');
    if (!is_within && c != ']') text += c;
  }
  return text;
}

[[noreturn]] void refuse(const Scene& scene, const std::string& key,
                         const std::vector<NumberPlace>& places)
{
  std::vector<std::string> known;
  for (const NumberPlace& place : places) {
    if (!place.key.starts_with(of_squeal)) continue;
    for (const std::string& name : {place.key, without_places(place.key)})
      if (!contains(known, name)) known.push_back(name);
  }
  const std::string near = nearest_name(key, known);
  const std::string hint =
      near.empty() ? "there are: " + quoted_list(known) : fmt::format("did you mean {}?", near);
  throw Error(fmt::format(
      "{}: {} is not a number in the scene, and only keys with a value there can vary; {}",
      scene.path, key, hint));
}

}  // namespace

std::vector<NumberPlace> number_places(std::string_view text)
{
  std::vector<NumberPlace> places;
  const toml::table table = parse_values(text);
  collect(text, table, "", places);
  std::ranges::sort(places, {}, &NumberPlace::from);
  return places;
}

std::vector<NumberPlace> places_of_squeal_key(const Scene& scene, const std::string& key)
{
  const std::vector<NumberPlace> all = number_places(scene.text);
  std::vector<NumberPlace> meant;
  std::ranges::copy_if(all, std::back_inserter(meant),
                       [&](const NumberPlace& place) { return is_meant(key, place.key); });
  if (meant.empty()) refuse(scene, key, all);
  if (!key.starts_with(of_squeal)) {
    refuse_key(scene, meant.front().key,
               "only keys of [squeal] can vary: other keys change the body, which is made before "
               "the sweep");
  }
  return meant;
}

std::string with_numbers(std::string_view text, std::span<const std::vector<NumberPlace>> places,
                         std::span<const double> values)
{
  std::map<std::size_t, std::pair<std::size_t, double>> changes;  // from -> to, value
  for (std::size_t i = 0; i < places.size(); ++i)
    for (const NumberPlace& place : places[i]) changes[place.from] = {place.to, values[i]};
  std::string changed;
  std::size_t at = 0;
  for (const auto& [from, change] : changes) {
    changed += text.substr(at, from - at);
    changed += fmt::format("{}", change.second);
    at = change.first;
  }
  return changed += text.substr(at);
}

}  // namespace chladni::scene
