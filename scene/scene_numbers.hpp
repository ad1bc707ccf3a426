#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace chladni::scene {

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
