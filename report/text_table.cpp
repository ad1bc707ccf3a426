#include "report/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <numeric>
#include <sstream>

#include "common/error.hpp"

namespace chladni::report {

namespace {

/// Cells may hold UTF-8; a continuation byte takes no column.
std::size_t width(std::string_view text)
{
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

/// Of a line that a person reads, and the least that a column is cut down to for it.
constexpr std::size_t widest_line = 120, narrowest_cut = 30;

/// The widest column gets no more than leaves the line readable.
std::vector<std::size_t> column_widths(const TextTable& table)
{
  std::vector<std::size_t> widths;
  for (std::size_t j = 0; j < table.header.size(); ++j) {
    widths.push_back(width(table.header[j]));
    for (const auto& row : table.rows) widths[j] = std::max(widths[j], width(row[j]));
  }
  const std::size_t line = std::reduce(widths.begin(), widths.end()) + 2 * (widths.size() - 1);
  std::size_t& widest = *std::ranges::max_element(widths);
  if (line > widest_line && widest > narrowest_cut)
    widest = std::max(narrowest_cut, widest - std::min(widest, line - widest_line));
  return widths;
}

/// The words of a cell in lines of at most so many columns, those behind the first one indented; a
/// longer word stays whole.
std::vector<std::string> wrapped(const std::string& cell, std::size_t most)
{
  constexpr std::string_view indent = "  ";
  if (width(cell) <= most) return {cell};
  std::vector<std::string> lines;
  std::istringstream words(cell);
  for (std::string word; words >> word;)
    if (lines.empty())
      lines.push_back(word);
    else if (width(lines.back()) + 1 + width(word) > most)
      lines.push_back(std::string(indent) + word);
    else
      lines.back() += " " + word;
  return lines;
}

/// The lines of a cell that takes several stand flush left.
std::string format_row(const std::vector<std::string>& cells,
                       const std::vector<std::size_t>& widths)
{
  std::vector<std::vector<std::string>> columns;
  std::size_t n_lines = 1;
  for (std::size_t j = 0; j < cells.size(); ++j) {
    columns.push_back(wrapped(cells[j], widths[j]));
    n_lines = std::max(n_lines, columns.back().size());
  }
  std::string text;
  for (std::size_t i = 0; i < n_lines; ++i) {
    std::string line;
    for (std::size_t j = 0; j < cells.size(); ++j) {
      const std::string cell = i < columns[j].size() ? columns[j][i] : "";
      const std::string blanks(widths[j] - std::min(widths[j], width(cell)), ' ');
      const bool is_left = j == 0 || columns[j].size() > 1;
      line += (j > 0 ? "  " : "") + (is_left ? cell + blanks : blanks + cell);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
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

std::string said(const std::exception& error)
{
  if (dynamic_cast<const std::bad_alloc*>(&error) == nullptr) return printable(error.what());
  return "out of memory; take a coarser mesh, fewer modes or fewer points, use more machines, or "
         "raise the limit of this shell (ulimit -v)";
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
