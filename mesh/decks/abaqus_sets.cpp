#include <fmt/format.h>

#include <algorithm>

#include "mesh/decks/abaqus.hpp"

namespace chladni::mesh {
namespace {

/// What GENERATE may stand for.
constexpr std::int64_t longest_set = 2'000'000;

void generate_numbers(const Keyword& keyword, const KeywordRow& row,
                      std::vector<std::int64_t>& numbers)
{
  const std::int64_t first = keyword.integer(row, 0, "number"),
                     last = keyword.integer(row, 1, "number");
  const bool has_step = !Keyword::field(row, 2).empty();
  const std::int64_t step = has_step ? keyword.integer(row, 2, "step") : 1;
  if (last < first || last - first > longest_set)
    keyword.refuse(row, fmt::format("{} to {} is no range of numbers", first, last));
  for (std::int64_t n = first; n <= last; n += step) numbers.push_back(n);
}

void add_row(const Keyword& keyword, const KeywordRow& row, const std::string& name,
             std::map<std::string, std::vector<std::int64_t>>& sets)
{
  std::vector<std::int64_t> numbers;
  if (keyword.has("GENERATE")) generate_numbers(keyword, row, numbers);
  for (std::size_t i = 0; i < row.fields.size() && !keyword.has("GENERATE"); ++i) {
    const std::string& field = row.fields[i];
    if (field.empty()) continue;
    if (keyword.is_integer(field)) {
      numbers.push_back(keyword.integer(row, i, "number"));
      continue;
    }
    const auto other = sets.find(field);
    if (other == sets.end()) keyword.refuse(row, fmt::format("there is no set \"{}\"", field));
    if (other->second.size() > longest_set) keyword.refuse(row, "holds too many numbers");
    numbers.insert(numbers.end(), other->second.begin(), other->second.end());
  }
  std::vector<std::int64_t>& set = sets[name];
  set.insert(set.end(), numbers.begin(), numbers.end());
  std::ranges::sort(set);
  set.erase(std::unique(set.begin(), set.end()), set.end());
}

/// The numbers of the nodes or elements that a keyword defines; an element goes over several lines
/// where one ends with a comma.
void add_defined(const Keyword& keyword, std::vector<std::int64_t>& set)
{
  bool goes_on = false;
  for (const KeywordRow& row : keyword.rows) {
    if (!goes_on) set.push_back(keyword.integer(row, 0, "number"));
    goes_on = keyword.name == "ELEMENT" && row.fields.back().empty();
  }
}

}  // namespace

std::span<const Keyword> abaqus_model(std::span<const Keyword> keywords)
{
  const auto step = std::ranges::find(keywords, "STEP", &Keyword::name);
  return keywords.first(std::size_t(step - keywords.begin()));
}

AbaqusSets abaqus_sets(std::span<const Keyword> keywords)
{
  AbaqusSets sets;
  for (const Keyword& keyword : abaqus_model(keywords)) {
    if (keyword.name == "NODE" && keyword.has("NSET"))
      add_defined(keyword, sets.nodes[keyword.parameter("NSET")]);
    if (keyword.name == "ELEMENT" && keyword.has("ELSET"))
      add_defined(keyword, sets.elements[keyword.parameter("ELSET")]);
    if (keyword.name == "NSET") {
      keyword.expect_only({"NSET", "GENERATE", "INTERNAL", "UNSORTED"});
      sets.nodes[keyword.parameter("NSET")];
      for (const KeywordRow& row : keyword.rows)
        add_row(keyword, row, keyword.parameter("NSET"), sets.nodes);
    }
    if (keyword.name == "ELSET") {
      keyword.expect_only({"ELSET", "GENERATE", "INTERNAL"});
      sets.elements[keyword.parameter("ELSET")];
      for (const KeywordRow& row : keyword.rows)
        add_row(keyword, row, keyword.parameter("ELSET"), sets.elements);
    }
  }
  return sets;
}

std::string name_of_node_set(const std::string& set, const AbaqusSets& sets)
{
  return sets.elements.contains(set) ? set + "_nodes" : set;
}

std::vector<std::int64_t> abaqus_nodes(const Keyword& keyword, const KeywordRow& row,
                                       std::string_view name, const AbaqusSets& sets)
{
  if (keyword.is_integer(name))
    return {keyword.integer({row.place, {std::string(name)}}, 0, "node")};
  const auto set = sets.nodes.find(std::string(name));
  if (set == sets.nodes.end())
    keyword.refuse(row, fmt::format("there is no node set \"{}\"", name));
  return set->second;
}

}  // namespace chladni::mesh
