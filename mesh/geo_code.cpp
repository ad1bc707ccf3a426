// By hand, since std::regex takes a frame of the stack for each character: a comment of a megabyte
// would end the program.
#include "mesh/geo_code.hpp"

#include <algorithm>
#include <cctype>

namespace chladni::mesh {
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
