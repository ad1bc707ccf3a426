#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace chladni::scene {

/// Where the number of a key stands in the text of a scene.
struct NumberPlace {
  std::string key;       ///< "squeal.pads[2].stiffness"; places in lists count from 1
  std::size_t from, to;  ///< bytes of the text
};

/// All numbers of a text in TOML, in its order.
std::vector<NumberPlace> number_places(std::string_view text);

/// The numbers that a key means: without its place, "squeal.pads.stiffness" is that of every table
/// of the list.
/// @throws chladni::Error naming file and key when the scene has no such number, or when it is not
///         one of [squeal]: all others belong to the body, which is made before.
std::vector<NumberPlace> places_of_squeal_key(const Scene& scene, const std::string& key);

/// The text of the scene with other numbers.
/// @param places  [n], those of one value each; no two overlap
/// @param values  [n]
std::string with_numbers(std::string_view text, std::span<const std::vector<NumberPlace>> places,
                         std::span<const double> values);

}  // namespace chladni::scene
