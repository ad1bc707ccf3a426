#include "scene/document_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace chladni::scene {

std::string value_text(const toml::node& value)
{
  if (const auto* text = value.as_string()) return fmt::format("\"{}\"", text->get());
  if (const auto* number = value.as_floating_point()) return fmt::format("{}", number->get());
  std::ostringstream stream;
  stream << toml::toml_formatter(value);
  std::string text = stream.str();
  std::ranges::replace(text, '\n', ' ');
  return text.size() <= 60 ? text : text.substr(0, 60) + " ...";
}

Objection objection_to_number(const Admissible& admissible)
{
  return [admissible](const toml::node& value) -> std::string {
    if (!value.is_number()) return "must be " + requirement(admissible, "a number");
    const bool admitted = admits(admissible, *value.value<double>());
    return admitted ? "" : "must be " + requirement(admissible);
  };
}

Objection objection_to_integer(const Admissible& admissible)
{
  return [admissible](const toml::node& value) -> std::string {
    if (!value.is_integer()) return "must be " + requirement(admissible, "a whole number");
    if (!value.value<int>()) return "is too large";
    return objection_to_number(admissible)(value);
  };
}

std::string objection_to_truth(const toml::node& value)
{
  return value.is_boolean() ? "" : "must be true or false";
}

std::string objection_to_text(const toml::node& value)
{
  if (!value.is_string()) return "must be a text in quotes";
  return value.as_string()->get().empty() ? "must not be empty" : "";
}

}  // namespace chladni::scene
