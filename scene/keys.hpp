#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/admissible.hpp"

namespace chladni::scene {

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

}  // namespace chladni::scene
