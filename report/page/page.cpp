#include "report/page/page.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "common/error.hpp"
#include "report/page/page_parts.hpp"

namespace chladni::report {

namespace {

/// `text` with each `from` replaced by `to`.
std::string with(std::string text, std::string_view from, std::string_view to)
{
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// As text between two HTML tags.
std::string as_html(std::string_view text)
{
  return with(with(with(std::string(text), "&", "&amp;"), "<", "&lt;"), ">", "&gt;");
}

/// JSON that no `</script>` or `<!--` in a text of it can end.
std::string as_script(std::string_view json)
{
  return with(std::string(json), "<", "\\u003c");
}

}  // namespace

std::string report_page(std::string_view title, const Json& content, std::string_view benchmark)
{
  // The content comes last, since it is the one part whose text is not ours.
  std::string page(page_parts::page_html);
  page = with(page, "/*STYLE*/", page_parts::style_css);
  std::string scripts;
  for (const std::string_view script : page_parts::scripts) scripts += script;
  page = with(page, "/*SCRIPTS*/", scripts);
  const std::string::size_type at = page.find("<!--CONTENT-->");
  const std::string texts = "<script type=\"application/json\" id=\"content\">" +
                            as_script(content.text()) +
                            "</script>\n<script type=\"application/json\" id=\"benchmark\">" +
                            as_script(benchmark) + "</script>\n";
  return with(page.substr(0, at), "<!--TITLE-->", as_html(title)) + texts + page.substr(at);
}

Json rounded(double x)
{
  return Json(std::strtod(fmt::format("{:.6g}", x).c_str(), nullptr));
}

Json rounded(std::span<const double> x)
{
  std::vector<Json> numbers;
  for (const double number : x) numbers.push_back(rounded(number));
  return Json::array(numbers);
}

Json rounded(const Eigen::VectorXd& x)
{
  return rounded(std::span(x.data(), static_cast<std::size_t>(x.size())));
}

Json rounded_rows(const Eigen::MatrixXd& rows)
{
  std::vector<Json> lists;
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    lists.push_back(rounded(Eigen::VectorXd(rows.row(i))));
  return Json::array(lists);
}

Json table_json(const std::string& title, const TextTable& table)
{
  std::vector<Json> rows;
  for (const auto& row : table.rows) rows.push_back(texts(row));
  return Json::object(
      {{"title", title}, {"header", texts(table.header)}, {"rows", Json::array(rows)}});
}

Json texts(const std::vector<std::string>& words)
{
  return Json::array({words.begin(), words.end()});
}

std::string base64(std::span<const std::byte> bytes)
{
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t triple = 0;
    for (std::size_t k = 0; k < 3; ++k)
      triple = triple << 8 | (k < n ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? digits[triple >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace chladni::report
