#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace chladni::scene {

/// The least accuracy that a scene may ask for.
inline constexpr double accuracy_error_max = 0.1;

/// The numbers that a key accepts; never infinite or NaN.
struct Admissible {
  double above = -std::numeric_limits<double>::infinity();     ///< exclusive
  double at_least = -std::numeric_limits<double>::infinity();  ///< inclusive
  double below = std::numeric_limits<double>::infinity();      ///< exclusive
  double at_most = std::numeric_limits<double>::infinity();    ///< inclusive
  std::string_view unit = {};                                  ///< for messages
  /// A number outside usual_from to usual_to gets a note, unless it is 1.
  double usual_from = -std::numeric_limits<double>::infinity();
  double usual_to = std::numeric_limits<double>::infinity();
  std::string_view usually = {};  ///< text of that note, such as "a steel has 2.1e11 Pa"
};

inline constexpr Admissible no_number{};  ///< of a key that has words or texts

/// Any number in this unit.
constexpr Admissible in(std::string_view unit)
{
  return {.unit = unit};
}

constexpr Admissible positive(std::string_view unit = {})
{
  return {.above = 0.0, .unit = unit};
}

constexpr Admissible not_negative(std::string_view unit = {})
{
  return {.at_least = 0.0, .unit = unit};
}

constexpr Admissible at_least(double smallest)
{
  return {.at_least = smallest};
}

constexpr Admissible from_to(double smallest, double largest, std::string_view unit = {})
{
  return {.at_least = smallest, .at_most = largest, .unit = unit};
}

/// The same numbers with a note on those above `usual_to`.
constexpr Admissible usually(Admissible numbers, double usual_to, std::string_view note)
{
  numbers.usual_to = usual_to;
  numbers.usually = note;
  return numbers;
}

/// Whether the number is accepted.
bool admits(const Admissible& admissible, double x);

/// The numbers that both accept. Unit and note are those of `b` if it has them, else those of `a`.
Admissible both(const Admissible& a, const Admissible& b);

/// The requirement as text, `> 0 and <= 5 (m)`, after `kind` if that is not empty.
std::string requirement(const Admissible& admissible, std::string_view kind = {});

/// Type of a key's value.
enum class KeyKind {
  number,
  numbers,
  integer,
  integers,
  text,
  texts,
  truth,
  word,  ///< one of `words`
  table,
  tables
};

/// One key of the scene file: its allowed values and its meaning. The readers check values by these
/// rows, and docs/reference/scene.md is generated from them.
struct Key {
  std::string_view path;  ///< "mesh.rings.name"; `*` is a name that the user chooses
  KeyKind kind;
  std::string_view absent;  ///< default value, "required", or when it is required
  std::string_view meaning;
  Admissible admits = {};  ///< for each number; relations between keys are checked by the reader
  std::string_view words = {};  ///< the allowed words, separated by ` | `
};

/// All keys by parts of the scene file, in the order of the reference.
std::span<const Key> mesh_keys();
std::span<const Key> model_keys();
std::span<const Key> reduction_keys();
std::span<const Key> response_keys();
std::span<const Key> squeal_keys();
std::span<const Key> brake_keys();
std::span<const Key> assembly_keys();
std::span<const Key> sound_keys();

/// The row of a key; null for an unknown key.
const Key* find_key(std::string_view path);

/// The allowed words of a row as a list.
std::vector<std::string> words_of(const Key& key);

/// All rows as Markdown, for docs/reference/scene.md.
std::string scene_reference();

/// Whether the list contains the name.
bool contains(const std::vector<std::string>& names, std::string_view name);

/// The names as `"a", "b", "c"` for messages; `(none)` for an empty list.
std::string quoted_list(const std::vector<std::string>& names);

/// The most similar name that differs by at most two letters (by one in a word of three).
/// @return empty when there is none
std::string nearest_name(std::string_view name, const std::vector<std::string>& names);

/// Why an unknown name of this kind is refused: `no such ring in the scene; did you mean "track"?
/// there are: "track", "rim"`.
std::string no_such_name(std::string_view kind, std::string_view name,
                         const std::vector<std::string>& names);

}  // namespace chladni::scene
