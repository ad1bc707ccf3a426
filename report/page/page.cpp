#include "report/page/page.hpp"

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

}  // namespace chladni::report
