#pragma once

#include <toml++/toml.h>

#include <functional>
#include <string>

#include "scene/admissible.hpp"

namespace chladni::scene {

/// A value as text for a message, on one line; strings are shown in full, other values with at most
/// 60 characters.
std::string value_text(const toml::node& value);

/// A check of a value: it returns what is wrong, or an empty text.
using Objection = std::function<std::string(const toml::node&)>;

Objection objection_to_number(const Admissible& admissible);
Objection objection_to_integer(const Admissible& admissible);
std::string objection_to_truth(const toml::node& value);
std::string objection_to_text(const toml::node& value);

}  // namespace chladni::scene
