#include "mesh/gmsh_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>

#include "common/error.hpp"

namespace chladni::mesh {

namespace {

/// The lines of a text, one after the other, from one of them on.
class Lines {
 public:
  Lines(std::string_view text, std::size_t begin) : rest_(text.substr(begin))
  {
    for (const char c : text.substr(0, begin)) number_ += c == '\n' ? 1 : 0;
  }
  std::string_view next()
  {
    const std::size_t end = rest_.find('\n');
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    return line;
  }
  bool at_end() const { return rest_.empty() || rest_.front() == '$'; }
  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// Takes the next word of a line.
std::string_view word(std::string_view& line)
{
  constexpr const char* blanks = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view found = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(found.size());
  return found;
}

/// 0 where none stands.
std::int64_t whole_number(std::string_view text)
{
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? value : 0;
}

/// What a word of a line says of a file.
struct Numbering {
  const std::string& file;
  Lines lines;

  void check_next()
  {
    std::string_view line = lines.next();
    const std::string_view number = word(line);
    const std::int64_t value = whole_number(number);
    constexpr std::int64_t greatest = std::numeric_limits<std::int32_t>::max();
    if (value >= 1 && value <= greatest) return;
    throw Error(
        fmt::format("mesh file {}, line {}: \"{}\" is no number of a node; those go from 1 to {}",
                    file, lines.number(), number, greatest));
  }
};

/// Version 2: the number of nodes, then each with its number first.
void check_one_list(Numbering numbering)
{
  std::string_view head = numbering.lines.next();
  const std::int64_t n = whole_number(word(head));
  for (std::int64_t i = 0; i < n && !numbering.lines.at_end(); ++i) numbering.check_next();
}

/// Version 4.1: blocks, each with all its numbers before its coordinates.
void check_blocks(Numbering numbering)
{
  numbering.lines.next();
  while (!numbering.lines.at_end()) {
    std::string_view head = numbering.lines.next();
    for (int i = 0; i < 3; ++i) word(head);
    const std::int64_t n = whole_number(word(head));
    for (std::int64_t i = 0; i < n && !numbering.lines.at_end(); ++i) numbering.check_next();
    for (std::int64_t i = 0; i < n && !numbering.lines.at_end(); ++i) numbering.lines.next();
  }
}

/// Of a text; what is binary is left to Gmsh.
void check_node_numbers(const std::string& file, std::string_view text)
{
  std::string_view format = Lines(text, text.find('\n', text.find("$MeshFormat")) + 1).next();
  const std::string_view version = word(format), is_binary = word(format);
  const std::size_t nodes = text.find("\n$Nodes");
  if (is_binary != "0" || nodes == std::string_view::npos) return;
  const Numbering numbering{file, Lines(text, text.find('\n', nodes + 1) + 1)};
  if (version.starts_with("2")) check_one_list(numbering);
  if (version == "4.1") check_blocks(numbering);
}

}  // namespace

std::string read_all(const std::string& file)
{
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

void check_msh_is_whole(const std::string& file)
{
  const std::string text = read_all(file);
  const bool begins_with_comments = text.starts_with("$Comments");
  if (!text.starts_with("$MeshFormat") &&
      !(begins_with_comments && text.find("\n$MeshFormat") != std::string::npos)) {
    throw Error(fmt::format(
        "mesh file {} is not a .msh of Gmsh: $MeshFormat is missing from its first line", file));
  }
  for (const std::string section :
       {"MeshFormat", "PhysicalNames", "Entities", "Nodes", "Elements"}) {
    const bool begun = text.find("$" + section + "\n") != std::string::npos ||
                       text.find("$" + section + "\r\n") != std::string::npos;
    const bool must_be_there = section == "Nodes" || section == "Elements";
    const bool ended = text.find("$End" + section) != std::string::npos;
    if (begun ? ended : !must_be_there) continue;
    throw Error(fmt::format("mesh file {} is cut off: ${}{} is missing", file, begun ? "End" : "",
                            section));
  }
  check_node_numbers(file, text);
}

// By hand, since std::regex takes a frame of the stack for each character: a comment of a megabyte
// would end the program.

namespace {

bool is_of_a_word(char c)
{
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Length of what begins with `opening`, up to the end of `closing`; 0 if the text does not begin
/// so.
std::size_t length_of(std::string_view text, std::string_view opening, std::string_view closing)
{
  if (!text.starts_with(opening)) return 0;
  const std::size_t end = text.find(closing, opening.size());
  return end == std::string_view::npos ? text.size() : end + closing.size();
}

/// What says nothing to Gmsh, at the beginning of the text: a comment or a blank.
std::size_t length_of_silence(std::string_view text)
{
  const std::size_t comment = std::max(length_of(text, "//", "\n"), length_of(text, "/*", "*/"));
  const bool is_blank = std::isspace(static_cast<unsigned char>(text.front())) != 0;
  return std::max(comment, std::size_t{is_blank ? 1u : 0u});
}

/// Whether `word` stands by itself.
bool stands_in(std::string_view text, std::string_view word)
{
  for (std::size_t at = text.find(word); at != std::string_view::npos;
       at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !is_of_a_word(text[at - 1]);
    if (begins && (end == text.size() || !is_of_a_word(text[end]))) return true;
  }
  return false;
}

/// What a statement assigns; empty if nothing.
std::string_view value_of(std::string_view statement)
{
  const std::size_t at = statement.rfind('=');
  if (at == std::string_view::npos) return {};
  statement.remove_prefix(std::min(statement.find_first_not_of(' ', at + 1), statement.size()));
  return statement;
}

/// `Printf("...") > "file"`: what is between brackets may compare.
bool prints_into_a_file(std::string_view statement)
{
  const std::size_t last = statement.rfind(')');
  return stands_in(statement, "Printf") && last != std::string_view::npos &&
         statement.find('>', last) != std::string_view::npos;
}

bool any_of(const std::vector<std::string>& statements, auto holds)
{
  return std::ranges::any_of(statements, holds);
}

}  // namespace

std::vector<std::string> geo_statements(std::string_view geo)
{
  std::vector<std::string> statements(1);
  bool is_after_silence = false;
  while (!geo.empty()) {
    const std::size_t silence = length_of_silence(geo), text = length_of(geo, "\"", "\"");
    if (silence == 0 && geo.front() == ';') {
      statements.emplace_back();
    } else if (silence == 0) {
      std::string& last = statements.back();
      if (is_after_silence && !last.empty()) last += ' ';
      last += text > 0 ? std::string("\"\"") : std::string(1, geo.front());
    }
    is_after_silence = silence > 0;
    geo.remove_prefix(std::max({silence, text, std::size_t{1}}));
  }
  return statements;
}

bool has_word(const std::vector<std::string>& statements, std::string_view word)
{
  return any_of(statements, [&](const std::string& each) { return stands_in(each, word); });
}

bool has_mesh_command(const std::vector<std::string>& statements)
{
  return any_of(statements, [](const std::string& each) {
    const std::string command = " " + each;
    return command.ends_with(" Mesh 1") || command.ends_with(" Mesh 2") ||
           command.ends_with(" Mesh 3");
  });
}

bool sets_algorithm_8(const std::vector<std::string>& statements)
{
  return sets_algorithm_8_of_a_surface(statements) ||
         any_of(statements, [](const std::string& each) {
           return stands_in(each, "Algorithm") && value_of(each) == "8";
         });
}

bool sets_algorithm_8_of_a_surface(const std::vector<std::string>& statements)
{
  return any_of(statements, [](const std::string& each) {
    return stands_in(each, "MeshAlgorithm Surface") && value_of(each) == "8";
  });
}

std::string acting_command(const std::vector<std::string>& statements)
{
  for (const char* command :
       {"SystemCall", "NonBlockingSystemCall", "OnelabRun", "Save", "CreateDir"})
    if (has_word(statements, command)) return command;
  return any_of(statements, prints_into_a_file) ? "Printf(...) > FILE" : "";
}

}  // namespace chladni::mesh
