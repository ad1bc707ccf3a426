#include "scene/scene_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "common/error.hpp"
#include "scene/names.hpp"
#include "scene/parse_values.hpp"

namespace chladni::scene {
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
