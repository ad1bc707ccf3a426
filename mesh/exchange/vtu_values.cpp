#include "mesh/exchange/vtu_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include "common/error.hpp"

namespace chladni::mesh {
namespace {

template <class T>
void append(std::vector<T>& values, std::string_view word)
{
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    throw Error(fmt::format("\"{}\" is no number", word.substr(0, 40)));
  values.push_back(value);
}

template <class From, class To>
void copy_bytes(const std::string& bytes, std::vector<To>& values)
{
  if (bytes.size() % sizeof(From) != 0) throw Error("ends in the midst of a number");
  values.resize(bytes.size() / sizeof(From));
  for (std::size_t i = 0; i < values.size(); ++i) {
    From value{};
    std::memcpy(&value, bytes.data() + i * sizeof(From), sizeof(From));
    // Signed numbers of one byte are numbers here, not characters.
    values[i] = static_cast<To>(value);  // NOLINT(bugprone-signed-char-misuse)
  }
}

void check_type(const std::string& type)
{
  for (const char* known : {"Float32", "Float64", "Int8", "UInt8", "Int16", "UInt16", "Int32",
                            "UInt32", "Int64", "UInt64"})
    if (type == known) return;
  throw Error(fmt::format("type \"{}\" is not known", type));
}

}  // namespace

void read_words(VtuArray& array, const std::string& type, std::string_view text)
{
  check_type(type);
  constexpr const char* blanks = " \t\r\n";
  for (std::size_t at = text.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
    const std::string_view word = text.substr(at, end - at);
    if (array.is_real)
      append(array.reals, word);
    else
      append(array.integers, word);
    at = text.find_first_not_of(blanks, end);
  }
}

void read_bytes(VtuArray& array, const std::string& type, const std::string& bytes)
{
  check_type(type);
  std::vector<std::int64_t>& integers = array.integers;
  if (type == "Float32") copy_bytes<float>(bytes, array.reals);
  if (type == "Float64") copy_bytes<double>(bytes, array.reals);
  if (type == "Int8") copy_bytes<std::int8_t>(bytes, integers);
  if (type == "UInt8") copy_bytes<std::uint8_t>(bytes, integers);
  if (type == "Int16") copy_bytes<std::int16_t>(bytes, integers);
  if (type == "UInt16") copy_bytes<std::uint16_t>(bytes, integers);
  if (type == "Int32") copy_bytes<std::int32_t>(bytes, integers);
  if (type == "UInt32") copy_bytes<std::uint32_t>(bytes, integers);
  if (type == "Int64") copy_bytes<std::int64_t>(bytes, integers);
  if (type == "UInt64") copy_bytes<std::uint64_t>(bytes, integers);
}

}  // namespace chladni::mesh
