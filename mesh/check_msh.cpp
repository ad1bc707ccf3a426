#include "mesh/check_msh.hpp"

#include <fmt/format.h>

#include <algorithm>
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

}  // namespace chladni::mesh
