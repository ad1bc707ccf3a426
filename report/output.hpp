#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace chladni::report {

/// The text with `?` for each control character (C0, DEL and C1) but newlines: titles and names
/// come from files, and must not command a terminal.
std::string printable(std::string_view text);

/// A table for terminals; every row has as many cells as the header.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// Columns two blanks apart, the first flush left, the others flush right; ends with a newline.
std::string format_table(const TextTable& table);

/// Flushes stdout.
/// @throws chladni::Error when not all that was printed can be written.
void finish_printing();

/// Makes the folder for the files of a program, if need be.
/// @throws chladni::Error when it cannot be made.
void make_folder(const std::filesystem::path& folder);

/// "transient: 42 %, 7 s left" for work that has run for `elapsed_s`.
/// @return nothing in the first two seconds, after which short work is over.
std::optional<std::string> progress_text(std::string_view phase, double fraction, double elapsed_s);

/// One line on stderr that tells how far the work is; it shows only where stderr is a terminal, and
/// is wiped out at the end.
class ProgressLine {
 public:
  ProgressLine() = default;
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param fraction  of the phase, 0 to 1; the clock starts anew with each new name of a phase
  void show(const std::string& phase, double fraction);

 private:
  using Clock = std::chrono::steady_clock;

  void wipe();
  void put(const std::string& text);

  std::string phase_;
  Clock::time_point start_;
  Clock::time_point shown_;
  bool visible_ = false;
};

}  // namespace chladni::report
