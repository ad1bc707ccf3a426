#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

#include "mesh/decks/deck.hpp"
#include "mesh/decks/deck_text.hpp"

/// Archives of Ansys, as CDWRITE and the Mechanical program write them: blocks of nodes, elements
/// and components between commands.

namespace chladni::mesh {

/// Reads NBLOCK, EBLOCK (SOLID) and CMBLOCK. Solids are of the group `mat_1` of their material,
/// shells of `sec_2` of their section; components have their names, nodes held by D are `d_123`,
/// masses and springs `mass21_7` and `combin14_8_1`. Collapsed hexahedra and quadrilaterals become
/// the wedges, tetrahedra and triangles that they stand for.
/// @throws chladni::Error naming line and command of a mistake, of an element type that is not
///         known, and of commands that would change the mesh or couple its nodes.
Deck ansys_deck(const std::string& text, const ReadIncluded& read = refuse_included);

/// Reads materials (MP, MPDATA), sections (SECTYPE, SECDATA, SECBLOCK), supports (D), masses and
/// springs.
/// @throws chladni::Error naming line and command of anything that a scene cannot express.
Declarations ansys_declarations(const std::string& text, const ReadIncluded& read,
                                const DeckUnits& units);

/// A command of an archive of Ansys with its arguments in capitals, and the rows of the block
/// behind it.
struct AnsysCommand {
  std::string place;  ///< "line 7"
  std::vector<std::string> words;
  std::string format;  ///< of the block: "(19I9)"
  std::vector<DeckLine> rows;

  const std::string& name() const { return words.front(); }
  /// Argument i, counted from 1; empty if there are fewer.
  std::string_view word(std::size_t i) const
  {
    return i < words.size() ? std::string_view(words[i]) : std::string_view();
  }

  /// Arguments as numbers.
  /// @param what  name of the argument for the message
  /// @throws chladni::Error naming line and command when it is none.
  std::int64_t whole(std::size_t i, const char* what) const;
  std::int64_t whole_or(std::size_t i, const char* what, std::int64_t otherwise) const;
  double real(std::size_t i, const char* what) const;
  double real_or_zero(std::size_t i, const char* what) const;

  /// Throws chladni::Error with line, command and `why`.
  [[noreturn]] void refuse(std::string_view why) const;
  [[noreturn]] void refuse(const DeckLine& row, std::string_view why) const;
};

/// The commands of an archive, without comments. Numbers that *SET gives to a name stand in its
/// place in later arguments.
/// @param lines  must outlive the commands
std::vector<AnsysCommand> ansys_commands(const DeckLines& lines);

/// Archives include no files.
std::string no_file_of_ansys(std::string_view line);

/// The fields of the rows of a block in columns: whole numbers first, then others.
class AnsysColumns {
 public:
  /// @param command  with a format as "(3I9,6E21.13E3)"; must outlive this object
  /// @throws chladni::Error when the format is none.
  explicit AnsysColumns(const AnsysCommand& command);

  /// The whole numbers of a row, up to its end, and the numbers behind them.
  /// @throws chladni::Error naming line and command when a field is none.
  std::vector<std::int64_t> whole(const DeckLine& row) const;
  std::vector<double> real(const DeckLine& row) const;

 private:
  std::vector<std::string_view> fields(const DeckLine& row, std::size_t first,
                                       std::size_t last) const;

  const AnsysCommand& command_;
  std::vector<std::size_t> widths_;
  std::size_t n_whole_ = 0;
};

/// The number that a text is; nothing if it is none, or not finite.
template <class T>
std::optional<T> number_of_ansys(std::string_view text)
{
  std::string digits = trimmed(text);
  for (char& c : digits) c = c == 'D' || c == 'd' ? 'E' : c;
  if (digits.starts_with('+')) digits.erase(0, 1);
  T value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace chladni::mesh
