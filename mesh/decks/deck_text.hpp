#pragma once

#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// Splitting the text of decks into lines and fields.
namespace chladni::mesh {

/// The text without blanks, tabs and carriage returns at both ends.
std::string trimmed(std::string_view text);

/// The text in capitals.
std::string capitals(std::string text);

/// The parts between the commas of a line, trimmed.
std::vector<std::string> cut_at_commas(std::string_view line);

/// The parts between the blanks of a line.
std::vector<std::string> words_of(std::string_view line);

/// Calls take(line, number) for each line that begins at or after the place `begin` of the text,
/// until it returns false. Lines are numbered from the start of the text, from 1.
void for_each_line(const std::string& text, std::size_t begin, auto&& take)
{
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t found = text.find('\n', at);
    const std::size_t end = found == std::string::npos ? text.size() : found;
    ++number;
    if (at >= begin && !take(std::string_view(text).substr(at, end - at), number)) return;
    at = end + 1;
  }
}

/// A line of a deck, and what messages call it.
struct DeckLine {
  std::string_view text;
  std::string place;  ///< "line 7", of an included file "line 7 of part.bdf"
};

/// Returns the text of a file that a deck includes, by its path from the folder of the deck.
using ReadIncluded = std::function<std::string(const std::string& file)>;

/// Refuses to include files, for decks that are no files themselves.
std::string refuse_included(const std::string& file);

/// The lines of a deck, with those of included files in the places of the lines that name them.
class DeckLines {
 public:
  /// Returns the file that a line includes, as it is named there; empty for any other line.
  using NameIncluded = std::string (*)(std::string_view line);

  /// @param text  must outlive this object
  /// @throws chladni::Error naming a line whose file cannot be read, or that leads back to itself.
  DeckLines(const std::string& text, NameIncluded included, const ReadIncluded& read);

  auto begin() const { return lines_.begin(); }
  auto end() const { return lines_.end(); }

 private:
  struct Sources;
  void add(const std::string& text, const std::string& file, Sources& sources);

  std::vector<DeckLine> lines_;
  std::deque<std::string> texts_;  ///< of included files
};

}  // namespace chladni::mesh
