#include "report/output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "common/error.hpp"

namespace chladni::report {
namespace {

/// Cells may hold UTF-8; a continuation byte takes no column.
std::size_t width(std::string_view text)
{
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

std::vector<std::size_t> column_widths(const TextTable& table)
{
  std::vector<std::size_t> widths;
  for (std::size_t j = 0; j < table.header.size(); ++j) {
    widths.push_back(width(table.header[j]));
    for (const auto& row : table.rows) widths[j] = std::max(widths[j], width(row[j]));
  }
  return widths;
}

std::string format_row(const std::vector<std::string>& cells,
                       const std::vector<std::size_t>& widths)
{
  std::string line = cells[0] + std::string(widths[0] - width(cells[0]), ' ');
  for (std::size_t j = 1; j < cells.size(); ++j)
    line += std::string(2 + widths[j] - width(cells[j]), ' ') + cells[j];
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

}  // namespace

std::string printable(std::string_view text)
{
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    const bool is_c1 = c == 0xC2 && next >= 0x80 && next < 0xA0;  // in UTF-8
    const bool is_control = (c < 0x20 && c != '\n') || c == 0x7F || is_c1;
    shown.push_back(is_control ? '?' : text[i]);
    if (is_c1) ++i;
  }
  return shown;
}

std::string format_table(const TextTable& table)
{
  const std::vector<std::size_t> widths = column_widths(table);
  std::string text = format_row(table.header, widths);
  for (const auto& row : table.rows) text += format_row(row, widths);
  return printable(text);
}

void finish_printing()
{
  if (std::fflush(stdout) != 0)
    throw Error(fmt::format("stdout: cannot be written ({})", std::strerror(errno)));
}

void make_folder(const std::filesystem::path& folder)
{
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (!std::filesystem::is_directory(folder)) {
    throw Error(fmt::format("{}: this folder cannot be made{}{}", folder.string(),
                            failure ? ": " : "", failure ? failure.message() : ""));
  }
}

}  // namespace chladni::report
