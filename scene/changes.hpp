#pragma once

#include <string>
#include <vector>

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

}  // namespace chladni::scene
