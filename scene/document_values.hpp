#pragma once

#include <toml++/toml.h>

#include <functional>
#include <string>

#include "scene/admissible.hpp"

namespace chladni::scene {

/// A value as a message shows it, on one line and not longer than that.
std::string value_text(const toml::node& value);

/// Says what is wrong with a value; nothing when it is as it should be.
using Objection = std::function<std::string(const toml::node&)>;

Objection objection_to_number(const Admissible& admissible);
Objection objection_to_integer(const Admissible& admissible);
std::string objection_to_truth(const toml::node& value);
std::string objection_to_text(const toml::node& value);

}  // namespace chladni::scene
