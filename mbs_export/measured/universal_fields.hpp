#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

/// Fields of a line of a universal file.
namespace chladni::mbs_export {

/// The text without blanks, tabulators and carriage returns around it.
std::string trimmed(const std::string& text);

/// A field in fixed columns, without blanks; empty where the line is shorter.
std::string field_of(const std::string& line, std::size_t first, std::size_t width);

/// A field as a whole number; nothing where it is none.
std::optional<std::int64_t> integer_in(const std::string& field);
/// A field as a finite number, with an exponent of E or D; nothing where it is none.
std::optional<double> real_in(const std::string& field);

/// Throws chladni::Error "FILE:LINE: WHAT".
[[noreturn]] void fail_at(const std::filesystem::path& path, std::size_t line,
                          const std::string& what);

}  // namespace chladni::mbs_export
