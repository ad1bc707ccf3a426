#pragma once

#include <Eigen/Core>

#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace chladni::report {

/// A JSON value, serialised when it is constructed (RFC 8259).
class Json {
 public:
  /// The value null.
  Json() = default;
  /// The shortest text that reads back as the same double; null when the number is not finite.
  Json(double number);
  template <std::integral Integer>
  requires(!std::same_as<Integer, bool>) Json(Integer number) : text_(std::to_string(number)) {}
  Json(std::string_view text);
  Json(const char* text) : Json(std::string_view(text)) {}
  Json(const std::string& text) : Json(std::string_view(text)) {}

  using Member = std::pair<std::string, Json>;
  static Json array(const std::vector<Json>& elements);
  /// An object whose members keep their order.
  static Json object(const std::vector<Member>& members);

  const std::string& text() const { return text_; }

 private:
  std::string text_ = "null";
};

/// Numbers as a JSON array.
Json numbers_json(const Eigen::VectorXd& values);

/// The number, or null when there is none.
Json optional_json(const std::optional<double>& x);

/// Angular frequencies in rad/s as a JSON array of frequencies in Hz.
Json frequencies_json(const Eigen::VectorXd& omega);

}  // namespace chladni::report
