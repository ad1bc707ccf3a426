#include "mesh/decks/deck_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "common/error.hpp"

namespace chladni::mesh {

std::string trimmed(std::string_view text)
{
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

std::string capitals(std::string text)
{
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::vector<std::string> cut_at_commas(std::string_view line)
{
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    words.push_back(trimmed(line.substr(at, end - at)));
    at = end + 1;
  }
  return words;
}

std::vector<std::string> words_of(std::string_view line)
{
  constexpr std::string_view blanks = " \t\r";
  std::vector<std::string> words;
  for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
    words.emplace_back(line.substr(at, end - at));
    at = line.find_first_not_of(blanks, end);
  }
  return words;
}

std::string refuse_included(const std::string& file)
{
  throw Error(fmt::format("the file {} cannot be included here", file));
}

struct DeckLines::Sources {
  NameIncluded included;
  const ReadIncluded& read;
  std::vector<std::string> open;  ///< files that are being read, each included by the one before
  int n_included;
};

DeckLines::DeckLines(const std::string& text, NameIncluded included, const ReadIncluded& read)
{
  Sources sources{.included = included, .read = read, .open = {}, .n_included = 0};
  add(text, "", sources);
}

void DeckLines::add(const std::string& text, const std::string& file, Sources& sources)
{
  constexpr int most_files = 1000;
  for_each_line(text, 0, [&](std::string_view line, int number) {
    std::string place =
        file.empty() ? fmt::format("line {}", number) : fmt::format("line {} of {}", number, file);
    const std::string named = sources.included(line);
    if (named.empty()) {
      lines_.push_back({line, std::move(place)});
      return true;
    }
    const std::string path =
        (std::filesystem::path(file).parent_path() / named).lexically_normal().string();
    if (std::ranges::find(sources.open, path) != sources.open.end())
      throw Error(fmt::format("{}: includes {}, which includes this file", place, path));
    if (++sources.n_included > most_files)
      throw Error(fmt::format("{}: more than {} files are included", place, most_files));
    try {
      texts_.push_back(sources.read(path));
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", place, error.what()));
    }
    sources.open.push_back(path);
    add(texts_.back(), path, sources);
    sources.open.pop_back();
    return true;
  });
}

}  // namespace chladni::mesh
