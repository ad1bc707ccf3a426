// The datasets are those of I-deas as the Structural Dynamics Research Laboratory of the University
// of Cincinnati describes them; descriptors of elements are I-deas's "FE descriptor id".

#include "mesh/exchange/unv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>

#include "common/error.hpp"
#include "mesh/decks/deck_text.hpp"
#include "mesh/decks/file_elements.hpp"

namespace chladni::mesh {

namespace {

/// Reads the numbers of a dataset one by one, across lines. All functions throw chladni::Error
/// naming line and dataset.
class UnvWords {
 public:
  /// @param dataset  must outlive this object
  explicit UnvWords(const UnvDataset& dataset) : dataset_(dataset) {}

  bool at_end();
  /// The next whole line, trimmed.
  std::string line();
  /// @param what  name of the number, for errors
  std::int64_t integer(const char* what);
  /// An integer of at least 1.
  std::int64_t number(const char* what);
  double real(const char* what);
  [[noreturn]] void refuse(std::string_view why) const;

 private:
  void next_line();
  void skip_blanks();
  std::string_view next(const char* what);

  const UnvDataset& dataset_;
  std::size_t line_ = 0, column_ = 0;
};

bool UnvWords::at_end()
{
  skip_blanks();
  return line_ == dataset_.lines.size();
}

std::string UnvWords::line()
{
  if (column_ > 0) next_line();
  if (line_ == dataset_.lines.size()) refuse("ends in the midst of a record");
  const std::string found = trimmed(dataset_.lines[line_]);
  next_line();
  return found;
}

std::int64_t UnvWords::integer(const char* what)
{
  const std::string_view word = next(what);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  constexpr std::int64_t greatest = 2'147'483'647;
  if (error == std::errc() && end == word.data() + word.size() && std::abs(value) <= greatest)
    return value;
  refuse(fmt::format("\"{}\" is no {}, which is a whole number", word, what));
}

std::int64_t UnvWords::number(const char* what)
{
  const std::int64_t value = integer(what);
  if (value < 1) refuse(fmt::format("{} is no {}; those go from 1", value, what));
  return value;
}

double UnvWords::real(const char* what)
{
  const std::string_view word = next(what);
  std::string text(word);
  for (char& c : text) c = c == 'D' || c == 'd' ? 'E' : c;
  if (text.starts_with('+')) text.erase(0, 1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(value))
    return value;
  refuse(fmt::format("\"{}\" is no number, which {} is", word, what));
}

void UnvWords::refuse(std::string_view why) const
{
  const auto line = std::min(line_ + 1, dataset_.lines.size());
  throw Error(fmt::format("line {}: dataset {}: {}", dataset_.line + static_cast<int>(line),
                          dataset_.number, why));
}

void UnvWords::next_line()
{
  ++line_;
  column_ = 0;
}

void UnvWords::skip_blanks()
{
  while (line_ < dataset_.lines.size()) {
    column_ = std::min(dataset_.lines[line_].find_first_not_of(" \t\r", column_),
                       dataset_.lines[line_].size());
    if (column_ < dataset_.lines[line_].size()) return;
    next_line();
  }
}

std::string_view UnvWords::next(const char* what)
{
  if (at_end()) refuse(fmt::format("ends where {} should stand", what));
  const std::string_view rest = dataset_.lines[line_].substr(column_);
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r"));
  column_ += word.size();
  return word;
}

class UnvReader {
 public:
  explicit UnvReader(double length_unit) : length_unit_(length_unit) {}

  ExchangeMesh read(const std::vector<UnvDataset>& datasets)
  {
    static const std::set<std::string> groups{"2435", "2452", "2467", "2477"};
    for (const UnvDataset& dataset : datasets) {
      if (dataset.number == "2411") nodes(UnvWords(dataset));
      if (dataset.number == "2412") elements(UnvWords(dataset));
      if (dataset.number == "164") units(UnvWords(dataset));
      if (!groups.contains(dataset.number)) check_is_known(dataset);
    }
    for (const UnvDataset& dataset : datasets)
      if (groups.contains(dataset.number)) read_groups(UnvWords(dataset));
    add_groups_of_properties();
    if (n_results_ > 0)
      mesh_.notes.push_back(fmt::format("{} datasets of results are left out", n_results_));
    return std::move(mesh_);
  }

 private:
  void check_is_known(const UnvDataset& dataset)
  {
    // The header, units, and coordinate systems, in which nodes are not given.
    static const std::set<std::string> known{"2411", "2412", "151", "164", "2420"};
    static const std::set<std::string> results{"55", "56", "57", "58", "2414"};
    static const std::set<std::string> older{"15",   "71",   "752",  "780", "781",
                                             "2417", "2429", "2430", "2432"};
    if (results.contains(dataset.number)) ++n_results_;
    if (known.contains(dataset.number) || results.contains(dataset.number)) return;
    const char* const why =
        older.contains(dataset.number)
            ? "an older form of nodes, elements or groups; write them as datasets 2411, 2412 and "
              "2467"
            : "it is not known; take it out if the mesh is the same without it";
    throw Error(fmt::format("line {}: dataset {}: {}", dataset.line, dataset.number, why));
  }

  void nodes(UnvWords words)
  {
    while (!words.at_end()) {
      const std::int64_t number = words.number("number of a node");
      for (const char* what : {"coordinate system", "displacement system", "colour"})
        words.integer(what);
      std::array<double, 3> x{};
      for (double& c : x) c = words.real("a coordinate");
      if (!mesh_.nodes.emplace(number, x).second)
        words.refuse(fmt::format("node {} is there twice", number));
    }
  }

  static const std::vector<FileElement>& known_descriptor(const UnvWords& words,
                                                          std::int64_t number, std::int64_t id)
  {
    const std::vector<FileElement>& types = file_elements(Format::unv, fmt::format("{}", id));
    if (!types.empty()) return types;
    const bool is_solid = id >= 101 && id <= 118;
    if (is_solid)
      words.refuse(fmt::format("element {} (descriptor {}) is {}", number, id, no_such_solid));
    words.refuse(
        fmt::format("element {} has the descriptor {}; known are beams (11 to 24), triangles and "
                    "quadrilaterals "
                    "of order 1 and 2 of shells, plates, membranes and plane elements (41 to 75, "
                    "91 to 95), and "
                    "solids of order 1 and 2 (111 to 113, 115, 116, 118)",
                    number, id));
  }

  /// The type of this number of nodes.
  static const FileElement& type_of(const UnvWords& words, const std::vector<FileElement>& types,
                                    std::int64_t number, std::size_t n_nodes)
  {
    const auto found = std::ranges::find(types, n_nodes, &FileElement::n_nodes);
    if (found != types.end()) return *found;
    words.refuse(fmt::format("element {} has {} nodes; that of its descriptor has {}", number,
                             n_nodes, types.front().n_nodes));
  }

  void elements(UnvWords words)
  {
    while (!words.at_end()) {
      const std::int64_t number = words.number("number of an element");
      const std::int64_t id = words.integer("FE descriptor");
      const std::int64_t property = words.integer("physical property");
      for (const char* what : {"material", "colour"}) words.integer(what);
      const std::int64_t n_nodes = words.integer("number of nodes");
      const std::vector<FileElement>& types = known_descriptor(words, number, id);
      if (types.front().shape == Shape::line)
        for (const char* what : {"orientation", "cross-section", "cross-section"})
          words.integer(what);
      const FileElement& type = type_of(words, types, number, std::size_t(n_nodes));
      std::vector<std::int64_t> nodes;
      for (std::int64_t k = 0; k < n_nodes; ++k) nodes.push_back(words.number("number of a node"));
      if (!place_of_.emplace(number, mesh_.elements.size()).second)
        words.refuse(fmt::format("element {} is there twice", number));
      mesh_.elements.push_back(deck_element(type, number, nodes, -1));
      property_of_.push_back(property);
    }
  }

  /// What universal files divide lengths by to have them in metres.
  void units(UnvWords words)
  {
    words.line();
    const double factor = words.real("a factor of lengths");
    if (!(factor > 0.0)) words.refuse(fmt::format("{} is no factor of lengths", factor));
    if (std::abs(1.0 / factor - length_unit_) <= 1e-6 * length_unit_) return;
    mesh_.notes.push_back(
        fmt::format("dataset 164 says that 1 is {:.6g} m; taken is what length_unit says, {:.6g} m",
                    1.0 / factor, length_unit_));
  }

  void read_groups(UnvWords words)
  {
    constexpr int behind_number = 6;
    while (!words.at_end()) {
      const std::int64_t number = words.integer("number of a group");
      for (int k = 0; k < behind_number; ++k) words.integer("a set of a group");
      const std::int64_t n = words.integer("number of members");
      std::string name = words.line();
      if (name.empty()) name = fmt::format("group_{}", number);
      if (!names_.insert({name, number}).second)
        words.refuse(fmt::format("group {} \"{}\" is there twice", number, name));
      read_members(words, name, n);
    }
  }

  void read_members(UnvWords& words, const std::string& name, std::int64_t n)
  {
    ExchangeGroup group{.name = name};
    int n_missing = 0;
    for (std::int64_t k = 0; k < n; ++k) {
      const std::int64_t type = words.integer("type of a member");
      const std::int64_t tag = words.number("number of a member");
      for (const char* what : {"leaf", "component"}) words.integer(what);
      if (type != 7 && type != 8) {
        words.refuse(fmt::format(
            "group \"{}\" has a member of type {}; known are nodes (7) and elements (8)", name,
            type));
      }
      const auto element = place_of_.find(tag);
      const bool is_there = type == 7 ? mesh_.nodes.contains(tag) : element != place_of_.end();
      n_missing += is_there ? 0 : 1;
      if (is_there && type == 7) group.nodes.push_back(tag);
      if (is_there && type == 8) group.elements.push_back(element->second);
    }
    if (n_missing > 0) {
      mesh_.notes.push_back(fmt::format("group \"{}\": {} of its {} members are not in the file",
                                        name, n_missing, n));
    }
    mesh_.groups.push_back(std::move(group));
  }

  void add_groups_of_properties()
  {
    std::vector<char> is_grouped(mesh_.elements.size(), 0);
    for (const ExchangeGroup& group : mesh_.groups)
      for (const std::size_t e : group.elements) is_grouped[e] = 1;
    std::map<std::pair<std::string, int>, ExchangeGroup> rest;
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
      if (is_grouped[e] != 0) continue;
      const int d = dimension(mesh_.elements[e].shape);
      const std::string name =
          fmt::format("property_{}{}", property_of_[e], d == 1 ? "_lines" : "");
      rest.emplace(std::pair(name, d), ExchangeGroup{.name = name})
          .first->second.elements.push_back(e);
    }
    for (auto& [key, group] : rest) mesh_.groups.push_back(std::move(group));
  }

  double length_unit_;
  ExchangeMesh mesh_;
  std::unordered_map<std::int64_t, std::size_t> place_of_;  ///< of elements by number
  std::vector<std::int64_t> property_of_;                   ///< by place
  std::set<std::pair<std::string, std::int64_t>> names_;
  int n_results_ = 0;
};

}  // namespace

ExchangeMesh unv_mesh(const std::string& text, double length_unit)
{
  return UnvReader(length_unit).read(unv_datasets(text));
}

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
