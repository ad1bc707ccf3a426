#pragma once

#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace chladni::report {

/// The text with `?` for each control character (C0, DEL and C1) but newlines: titles and names
/// come from files, and must not command a terminal.
std::string printable(std::string_view text);

/// What went wrong, for a terminal: the error's own words, or a sentence where memory ran out,
/// which the standard library calls by the name of a type.
std::string said(const std::exception& error);

/// A table for terminals; every row has as many cells as the header.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// Columns two blanks apart, the first flush left, the others flush right; ends with a newline.
/// Where lines would be longer than 120, the cells of the widest column take several,
/// indented behind the first.
std::string format_table(const TextTable& table);

/// Flushes stdout.
/// @throws chladni::Error when not all that was printed can be written.
void finish_printing();

/// Makes the folder for the files of a program, if need be.
/// @throws chladni::Error when it cannot be made.
void make_folder(const std::filesystem::path& folder);

}  // namespace chladni::report
