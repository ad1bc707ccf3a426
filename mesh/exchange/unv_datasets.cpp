#include <fmt/format.h>

#include "common/error.hpp"
#include "mesh/decks/deck_text.hpp"
#include "mesh/exchange/unv.hpp"

namespace chladni::mesh {
namespace {

/// Whether a line has nothing but numbers, as those of datasets. Words of people stand between
/// datasets too.
bool is_of_numbers(std::string_view words)
{
  return words.find_first_not_of("0123456789+-.eEdD \t") == std::string_view::npos &&
         words.find_first_of("0123456789") != std::string_view::npos;
}

}  // namespace

std::vector<UnvDataset> unv_datasets(const std::string& text)
{
  enum class State { outside, at_number, inside };
  State state = State::outside;
  std::vector<UnvDataset> datasets;
  for_each_line(text, 0, [&](std::string_view line, int number) {
    const std::string words = trimmed(line);
    if (state == State::inside) {
      if (words == "-1")
        state = State::outside;
      else
        datasets.back().lines.push_back(line);
    } else if (state == State::at_number) {
      if (words.empty())
        throw Error(fmt::format("line {}: the number of a dataset is missing", number));
      datasets.push_back({.number = words, .line = number, .lines = {}});
      state = State::inside;
    } else if (words == "-1") {
      state = State::at_number;
    } else if (is_of_numbers(words)) {
      throw Error(
          fmt::format("line {}: \"{}\" stands where a dataset begins, with -1 in a line of its own",
                      number, words.substr(0, 40)));
    }
    return true;
  });
  if (state != State::outside) {
    const std::string which = datasets.empty() ? "" : " " + datasets.back().number;
    throw Error(fmt::format("the file is cut off: its last dataset{} does not end with -1", which));
  }
  return datasets;
}

}  // namespace chladni::mesh
