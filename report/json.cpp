#include "report/json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace chladni::report {

namespace {

std::string escaped(char c)
{
  switch (c) {
    case '"':
      return "\\\"";
    case '\\':
      return "\\\\";
    case '\n':
      return "\\n";
    case '\t':
      return "\\t";
    case '\r':
      return "\\r";
    default:
      return static_cast<unsigned char>(c) < 0x20 ? fmt::format("\\u{:04x}", c) : std::string{c};
  }
}

std::string in_quotes(std::string_view text)
{
  std::string result = "\"";
  for (const char c : text) result += escaped(c);
  return result + "\"";
}

}  // namespace

Json::Json(double number) : text_(std::isfinite(number) ? fmt::format("{}", number) : "null") {}

Json::Json(std::string_view text) : text_(in_quotes(text)) {}

Json Json::array(const std::vector<Json>& elements)
{
  Json json;
  json.text_ = "[";
  for (const Json& element : elements)
    json.text_ += (json.text_.size() > 1 ? ", " : "") + element.text_;
  json.text_ += "]";
  return json;
}

Json Json::object(const std::vector<Member>& members)
{
  Json json;
  json.text_ = "{";
  for (const auto& [name, value] : members)
    json.text_ += (json.text_.size() > 1 ? ", " : "") + in_quotes(name) + ": " + value.text_;
  json.text_ += "}";
  return json;
}

Json numbers_json(const Eigen::VectorXd& values)
{
  std::vector<Json> numbers;
  for (const double value : values) numbers.emplace_back(value);
  return Json::array(numbers);
}

Json optional_json(const std::optional<double>& x)
{
  return x ? Json(*x) : Json();
}

Json frequencies_json(const Eigen::VectorXd& omega)
{
  return numbers_json(omega / (2.0 * std::numbers::pi));
}

}  // namespace chladni::report
