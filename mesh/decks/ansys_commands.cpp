#include "mesh/decks/ansys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "common/error.hpp"

namespace chladni::mesh {

void AnsysCommand::refuse(std::string_view why) const
{
  throw Error(fmt::format("{}: {}: {}", place, name(), why));
}

void AnsysCommand::refuse(const DeckLine& row, std::string_view why) const
{
  throw Error(fmt::format("{}: {}: {}", row.place, name(), why));
}

std::int64_t AnsysCommand::whole(std::size_t i, const char* what) const
{
  constexpr double greatest = 2'147'483'647.0;
  const auto value = number_of_ansys<double>(word(i));  // some are written as 3.
  if (value && *value == std::floor(*value) && std::abs(*value) <= greatest)
    return static_cast<std::int64_t>(*value);
  refuse(fmt::format("\"{}\" is no {}, which is a whole number", word(i), what));
}

std::int64_t AnsysCommand::whole_or(std::size_t i, const char* what, std::int64_t otherwise) const
{
  return word(i).empty() ? otherwise : whole(i, what);
}

double AnsysCommand::real(std::size_t i, const char* what) const
{
  if (const auto value = number_of_ansys<double>(word(i))) return *value;
  refuse(fmt::format("\"{}\" is no number, which {} is", word(i), what));
}

double AnsysCommand::real_or_zero(std::size_t i, const char* what) const
{
  return word(i).empty() ? 0.0 : real(i, what);
}

AnsysColumns::AnsysColumns(const AnsysCommand& command) : command_(command)
{
  // Each part is a count, a letter, a width, and what does not matter.
  constexpr std::string_view digits = "0123456789";
  std::string_view rest = command.format;
  const auto number = [&]() -> std::size_t {
    const std::size_t end = std::min(rest.find_first_not_of(digits), rest.size());
    const auto value = number_of_ansys<std::size_t>(rest.substr(0, end));
    rest.remove_prefix(end);
    constexpr std::size_t most = 1000;
    if (!value || *value == 0 || *value > most)
      command.refuse(fmt::format("\"{}\" is no format of a block", command.format));
    return *value;
  };
  while (true) {
    rest.remove_prefix(std::min(rest.find_first_of(digits), rest.size()));
    if (rest.empty()) break;
    const std::size_t n = number();
    const bool is_whole = rest.starts_with('I');
    rest.remove_prefix(std::min<std::size_t>(1, rest.size()));
    widths_.insert(widths_.end(), n, number());
    if (is_whole) n_whole_ += n;
    rest.remove_prefix(std::min(rest.find(','), rest.size()));
  }
  if (n_whole_ == 0)
    command.refuse(fmt::format("\"{}\" is no format of a block of numbers", command.format));
}

std::vector<std::int64_t> AnsysColumns::whole(const DeckLine& row) const
{
  std::vector<std::int64_t> numbers;
  for (const std::string_view text : fields(row, 0, n_whole_)) {
    const auto value = number_of_ansys<std::int64_t>(text);
    constexpr std::int64_t greatest = 2'147'483'647;
    if (!value || *value > greatest || *value < -greatest) {
      command_.refuse(row, fmt::format("\"{}\" is no whole number in the columns of {}",
                                       trimmed(text), command_.format));
    }
    numbers.push_back(*value);
  }
  return numbers;
}

std::vector<double> AnsysColumns::real(const DeckLine& row) const
{
  std::vector<double> numbers;
  for (const std::string_view text : fields(row, n_whole_, widths_.size())) {
    const auto value = number_of_ansys<double>(text);
    if (!value) {
      command_.refuse(row, fmt::format("\"{}\" is no number in the columns of {}", trimmed(text),
                                       command_.format));
    }
    numbers.push_back(*value);
  }
  return numbers;
}

/// Those that are not blank.
std::vector<std::string_view> AnsysColumns::fields(const DeckLine& row, std::size_t first,
                                                   std::size_t last) const
{
  std::vector<std::string_view> found;
  std::size_t at = 0;
  for (std::size_t i = 0; i < last && at < row.text.size(); ++i) {
    const std::string_view text = row.text.substr(at, widths_[i]);
    at += widths_[i];
    if (i >= first && !trimmed(text).empty()) found.push_back(text);
  }
  return found;
}

std::string no_file_of_ansys(std::string_view)
{
  return "";
}

namespace {

bool has_rows_of_ansys(const std::string& name)
{
  static const std::set<std::string> blocks{"NBLOCK",  "EBLOCK",  "ETBLOCK",
                                            "CMBLOCK", "RLBLOCK", "SECBLOCK"};
  return blocks.contains(name);
}

bool begins_with_number(std::string_view text)
{
  return std::string_view("0123456789+-.").find(text.front()) != std::string_view::npos;
}

}  // namespace

std::vector<AnsysCommand> ansys_commands(const DeckLines& lines)
{
  std::vector<AnsysCommand> commands;
  std::map<std::string, std::string> parameters;
  bool in_block = false;
  for (const DeckLine& line : lines) {
    const std::string text = capitals(trimmed(line.text.substr(0, line.text.find('!'))));
    if (text.empty()) continue;
    if (in_block && text.front() == '(') {  // RLBLOCK has a second one, of further rows
      if (commands.back().format.empty()) commands.back().format = text;
      continue;
    }
    if (in_block && begins_with_number(text)) {
      commands.back().rows.push_back(line);
      continue;
    }
    std::vector<std::string> words = cut_at_commas(text);
    const bool sets = words[0] == "*SET" && words.size() > 2;
    if (sets && number_of_ansys<double>(words[2])) parameters[words[1]] = words[2];
    for (std::size_t i = 1; i < words.size() && !sets; ++i)
      if (const auto value = parameters.find(words[i]); value != parameters.end())
        words[i] = value->second;
    in_block = has_rows_of_ansys(words[0]);
    commands.push_back({.place = line.place, .words = std::move(words), .format = "", .rows = {}});
  }
  return commands;
}

}  // namespace chladni::mesh
