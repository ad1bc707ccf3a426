#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report/json.hpp"
#include "report/text_table.hpp"

namespace chladni::report {

/// The HTML page with everything it needs inside.
/// @param benchmark  JSON text of a benchmark to draw as well, or "null"
std::string report_page(std::string_view title, const Json& content, std::string_view benchmark);

/// Bytes as base64 text (RFC 4648), for binary numbers in a page.
std::string base64(std::span<const std::byte> bytes);

/// A number with six digits for a picture; null when it is not finite.
Json rounded(double x);

/// A list of numbers with six digits.
Json rounded(std::span<const double> x);
Json rounded(const Eigen::VectorXd& x);

/// The rows of a matrix as a list of lists.
Json rounded_rows(const Eigen::MatrixXd& rows);

/// Numbers in their binary representation as base64 text.
template <class Number>
Json packed(const std::vector<Number>& numbers)
{
  return Json(base64(std::as_bytes(std::span(numbers))));
}

/// JSON members `title`, `header` and `rows`.
Json table_json(const std::string& title, const TextTable& table);

/// A JSON list of texts.
Json texts(const std::vector<std::string>& words);

}  // namespace chladni::report
