#include "mbs_export/measured/universal_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/error.hpp"

namespace chladni::mbs_export {
namespace {

template <class Number>
std::optional<Number> number_in(std::string field)
{
  std::ranges::replace(field, 'D', 'E');
  std::ranges::replace(field, 'd', 'e');
  if (field.starts_with('+')) field.erase(0, 1);
  Number value{};
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string trimmed(const std::string& text)
{
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string field_of(const std::string& line, std::size_t first, std::size_t width)
{
  return first < line.size() ? trimmed(line.substr(first, width)) : "";
}

std::optional<std::int64_t> integer_in(const std::string& field)
{
  return number_in<std::int64_t>(field);
}

std::optional<double> real_in(const std::string& field)
{
  const auto value = number_in<double>(field);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

void fail_at(const std::filesystem::path& path, std::size_t line, const std::string& what)
{
  throw Error(fmt::format("{}:{}: {}", path.string(), line, what));
}

}  // namespace chladni::mbs_export
