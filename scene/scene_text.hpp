#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace chladni::scene {

/// The steps of a study, each of which uses the result of the step before.
enum class Step {
  reduction,  ///< structure, interface and [reduce]
  body,       ///< [body]
  squeal,     ///< [squeal]
  radiation,  ///< the keys of [sound] about body and air
  sound       ///< all of [sound]
};

/// The changes of the keys that a step itself depends on between two texts of a scene, such as
/// "section.thickness = 0.018 (was 0.02)". Numbers are compared by value, not by spelling. A key
/// that was removed is listed too.
/// @return empty also when one of the texts is not a scene or does not describe the step: a scene
///         with [squeal] alone may use any body
std::vector<std::string> changed_keys(const std::string& then, const std::string& now, Step step);

/// The position of a key's number in the text of a scene.
struct NumberPlace {
  std::string key;       ///< such as "squeal.pads[2].stiffness"; list indices count from 1
  std::size_t from, to;  ///< range of bytes in the text
};

/// All numbers of a TOML text, in the order of the text.
std::vector<NumberPlace> number_places(std::string_view text);

/// The numbers that a key refers to. A key without list indices, such as "squeal.pads.stiffness",
/// refers to every table of the list.
/// @throws chladni::Error naming file and key when the scene has no such number, or when it is not
///         in [squeal]: all other numbers belong to the body, which is made before.
std::vector<NumberPlace> places_of_squeal_key(const Scene& scene, const std::string& key);

/// The text of the scene with other numbers.
/// @param places  [n] the places of each value; no two overlap
/// @param values  [n]
std::string with_numbers(std::string_view text, std::span<const std::vector<NumberPlace>> places,
                         std::span<const double> values);

}  // namespace chladni::scene
