#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace chladni::scene {
namespace {

/// Levenshtein: the fewest insertions, deletions and replacements that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

bool contains(const std::vector<std::string>& names, std::string_view name)
{
  return std::ranges::find(names, name) != names.end();
}

std::string quoted_list(const std::vector<std::string>& names)
{
  std::string text;
  for (const std::string& name : names)
    text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name);
  return text.empty() ? "(none)" : text;
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& names)
{
  std::string nearest;
  std::size_t least = name.size() < 4 ? 2 : 3;  // one more than the slips that are forgiven
  for (const std::string& candidate : names) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string no_such_name(std::string_view kind, std::string_view name,
                         const std::vector<std::string>& names)
{
  const std::string near = nearest_name(name, names);
  const std::string hint = near.empty() ? "" : fmt::format(" did you mean \"{}\"?", near);
  constexpr std::size_t most = 30;  // the curves of a .step may be hundreds
  const auto n_listed = static_cast<std::ptrdiff_t>(std::min(names.size(), most));
  const std::string more =
      names.size() > most ? fmt::format(" and {} more", names.size() - most) : "";
  return fmt::format("no such {} in the scene;{} there are: {}{}", kind, hint,
                     quoted_list({names.begin(), names.begin() + n_listed}), more);
}

}  // namespace chladni::scene
