#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/admissible.hpp"

namespace chladni::scene {

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

/// One key of the scene file: what its value must be, and what it means. The readers check values
/// by these rows, and docs/reference/scene.md is written from them.
struct Key {
  std::string_view path;  ///< "mesh.rings.name"; `*` is a name that the user chooses
  KeyKind kind;
  std::string_view absent;  ///< without it: "required", a default, or when it is needed
  std::string_view meaning;
  Admissible admits = {};       ///< each number; relations between keys are the reader's
  std::string_view words = {};  ///< of a word, separated by ` | `
};

/// Every key, in the order of the reference.
std::span<const Key> mesh_keys();
std::span<const Key> model_keys();
std::span<const Key> reduction_keys();
std::span<const Key> response_keys();
std::span<const Key> squeal_keys();
std::span<const Key> brake_keys();
std::span<const Key> assembly_keys();
std::span<const Key> sound_keys();

/// The row of a key; null for one that no table has.
const Key* find_key(std::string_view path);

/// The words of a row, each by itself.
std::vector<std::string> words_of(const Key& key);

/// The rows as text for people, in Markdown.
std::string scene_reference();

}  // namespace chladni::scene
