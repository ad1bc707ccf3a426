#pragma once

#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace chladni::report {

/// The text with `?` for each control character (C0, DEL and C1) except newlines. Titles and names
/// come from files and must not control a terminal.
std::string printable(std::string_view text);

/// The message of an error for the terminal. For std::bad_alloc, whose own message is the name of a
/// type, it is a sentence.
std::string said(const std::exception& error);

/// A table for the terminal; every row has as many cells as the header.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// The table as text that ends with a newline: columns two blanks apart, the first aligned left,
/// the others right. When a line would be longer than 120 characters, the cells of the widest
/// column take several lines, indented after the first.
std::string format_table(const TextTable& table);

/// Flushes stdout.
/// @throws chladni::Error when not all output could be written.
void finish_printing();

/// Creates the output folder if needed.
/// @throws chladni::Error when it cannot be created.
void make_folder(const std::filesystem::path& folder);

}  // namespace chladni::report
