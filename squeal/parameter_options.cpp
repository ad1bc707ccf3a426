#include "squeal/parameter_options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstddef>
#include <system_error>

#include "common/error.hpp"

namespace chladni::squeal {
namespace {

constexpr std::string_view of_pads = "pads.", of_one_pad = "pads[";

/// The row of a key of pads without "pads.".
const ParameterRow* find_of_pads(std::string_view rest)
{
  for (const ParameterRow& row : parameters) {
    if (row.of != ParameterOf::body && row.of != ParameterOf::any) continue;
    const bool is_short = row.name == "preload" || row.name == "stiffness" || row.name == "damping";
    if (is_short && row.name == rest) return &row;
    if (row.name.starts_with(of_pads) && row.name.substr(of_pads.size()) == rest) return &row;
  }
  return nullptr;
}

}  // namespace

std::string key_of(MapParameter parameter)
{
  if (parameter.pad == 0) return std::string(parameter.name);
  const bool is_long = parameter.name.starts_with(of_pads);
  return fmt::format("pads[{}].{}", parameter.pad,
                     is_long ? parameter.name.substr(of_pads.size()) : parameter.name);
}

std::optional<MapParameter> parameter_of(std::string_view key)
{
  if (!key.starts_with(of_one_pad)) {
    const ParameterRow* const row = find_parameter(key);
    return row ? std::optional(MapParameter{row->name}) : std::nullopt;
  }
  key.remove_prefix(of_one_pad.size());
  int pad = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), pad);
  key.remove_prefix(static_cast<std::size_t>(end - key.data()));
  if (error != std::errc() || pad < 1 || !key.starts_with("].")) return std::nullopt;
  const ParameterRow* const row = find_of_pads(key.substr(2));
  return row ? std::optional(MapParameter{row->name, pad}) : std::nullopt;
}

void set_parameter(double* at, MapParameter parameter, double value)
{
  if (!at) {
    throw Error(fmt::format(
        "[squeal] \"{}\" cannot vary: the brake has no such key; give it a value in the "
        "scene, or vary another one",
        key_of(parameter)));
  }
  *at = value;
}

}  // namespace chladni::squeal
