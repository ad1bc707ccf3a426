#pragma once

#include <string>
#include <vector>

namespace chladni::scene {

/// What is made of a scene, one out of the other.
enum class Step {
  reduction,  ///< of everything that describes the structure, its interface and [reduce]
  body,       ///< of [body]
  squeal,     ///< of [squeal]
  radiation,  ///< of what [sound] says of the body and of the air
  sound       ///< of all of [sound]
};

/// The keys that a step itself depends on and whose values differ between two texts of a scene:
/// "section.thickness = 0.018 (was 0.02)". Numbers are equal when their values are, whatever their
/// spelling; a key of `then` that is missing in `now` is told too.
/// @return empty also when one of the texts is no scene, or describes nothing of the step: a scene
///         with [squeal] alone may use any body.
std::vector<std::string> changed_keys(const std::string& then, const std::string& now, Step step);

}  // namespace chladni::scene
