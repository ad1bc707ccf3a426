#include "mbs_export/formats/mat_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "common/error.hpp"

namespace chladni::mbs_export::formats {
namespace {

/// Types of data and classes of arrays, tables 1-1 and 1-3 of the source.
enum class Type : std::int32_t {
  int8 = 1,
  uint16 = 4,
  int32 = 5,
  uint32 = 6,
  real = 9,
  matrix = 14,
  utf16 = 17
};
enum class Class : std::uint32_t { cell = 1, structure = 2, characters = 4, real = 6 };

template <class T>
std::string bytes_of(std::span<const T> values)
{
  std::string bytes(values.size_bytes(), '\0');
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// Type and number of bytes, the bytes, and zeros up to a multiple of 8.
std::string element(Type type, const std::string& bytes)
{
  if (bytes.size() > std::size_t(std::numeric_limits<std::int32_t>::max())) {
    throw Error(
        fmt::format("a MAT-file of version 5 holds arrays of up to 2 GiB, and one has {} bytes; "
                    "leave pictures out (reduce.pictures), or read the HDF5 file: h5read",
                    bytes.size()));
  }
  const std::int32_t tag[]{std::int32_t(type), std::int32_t(bytes.size())};
  return bytes_of<std::int32_t>(tag) + bytes + std::string((8 - bytes.size() % 8) % 8, '\0');
}

std::string flags_and_extents(Class kind, Eigen::Index rows, Eigen::Index cols)
{
  const std::uint32_t flags[]{std::uint32_t(kind), 0};
  const std::int32_t extents[]{std::int32_t(rows), std::int32_t(cols)};
  return element(Type::uint32, bytes_of<std::uint32_t>(flags)) +
         element(Type::int32, bytes_of<std::int32_t>(extents));
}

std::string named(const std::string& name, const MatArray& x)
{
  return element(Type::matrix, x.before_name + element(Type::int8, name) + x.after_name);
}

/// How many bytes of UTF-8 the character has that begins so; 1 for what begins none.
std::size_t length_of(unsigned char first)
{
  if (first >= 0xF0) return 4;
  if (first >= 0xE0) return 3;
  return first >= 0xC0 ? 2 : 1;
}

/// A unit for each character; for those beyond U+FFFF that of an unknown one.
std::vector<std::uint16_t> utf16_of(const std::string& text)
{
  std::vector<std::uint16_t> units;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const std::size_t n = std::min(length_of(first), text.size() - i);
    std::uint32_t code = n == 1 ? first : first & (0x7FU >> n);
    for (std::size_t k = 1; k < n; ++k)
      code = code << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3FU);
    i += n;
    // scipy takes pairs of units for two characters, and then refuses the file.
    constexpr std::uint32_t unknown = 0xFFFD;
    units.push_back(std::uint16_t(code > 0xFFFF ? unknown : code));
  }
  return units;
}

}  // namespace

MatArray mat_array(const Eigen::MatrixXd& x)
{
  return {.before_name = flags_and_extents(Class::real, x.rows(), x.cols()),
          .after_name = element(
              Type::real, bytes_of(std::span<const double>(x.data(), std::size_t(x.size()))))};
}

MatArray mat_array(const std::string& text)
{
  const std::vector<std::uint16_t> units = utf16_of(text);
  // What MATLAB itself writes is uint16, of which scipy takes one byte.
  const bool is_ascii = std::ranges::all_of(units, [](std::uint16_t unit) { return unit < 0x80; });
  return {
      .before_name = flags_and_extents(Class::characters, units.empty() ? 0 : 1, std::ssize(units)),
      .after_name = element(is_ascii ? Type::uint16 : Type::utf16, bytes_of<std::uint16_t>(units))};
}

MatArray mat_array(const std::vector<std::string>& texts)
{
  MatArray cells{.before_name = flags_and_extents(Class::cell, std::ssize(texts), 1),
                 .after_name = {}};
  for (const std::string& text : texts) cells.after_name += named("", mat_array(text));
  return cells;
}

MatArray mat_array(const std::vector<MatFields>& elements)
{
  constexpr std::int32_t name_size = 32;
  const std::int32_t size_of_names[]{4 << 16 | std::int32_t(Type::int32), name_size};
  MatArray structs{.before_name = flags_and_extents(Class::structure, 1, std::ssize(elements)),
                   .after_name = bytes_of<std::int32_t>(size_of_names)};
  std::string names;
  if (!elements.empty())
    for (const auto& [name, value] : elements.front())
      names += name + std::string(name_size - name.size(), '\0');
  structs.after_name += element(Type::int8, names);
  for (const MatFields& fields : elements)
    for (const auto& [name, value] : fields) structs.after_name += named("", value);
  return structs;
}

std::string mat_file(const std::string& description, const std::string& name, const MatArray& x)
{
  std::string header = description.substr(0, 116);
  header.resize(116, ' ');
  header.resize(124, '\0');  // no data of subsystems
  const std::uint16_t version_and_order[]{0x0100, 'M' << 8 | 'I'};
  return header + bytes_of<std::uint16_t>(version_and_order) + named(name, x);
}

}  // namespace chladni::mbs_export::formats
