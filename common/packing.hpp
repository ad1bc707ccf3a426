#pragma once

#include <array>
#include <concepts>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/error.hpp"

/// Values as a sequence of bytes, between processes of one build on one machine. Before each value
/// stands its kind, so that programs of two builds that pack other values do not misunderstand each
/// other.
namespace chladni {

/// One byte for each kind of value that is packed.
namespace packed_kind {
template <typename T>
consteval char number()
{
  const int of = std::is_floating_point_v<T> ? 0x40 : std::is_enum_v<T> ? 0x20 : 0;
  return static_cast<char>(of + sizeof(T));
}
template <typename T>
consteval char sequence()
{
  if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
    return static_cast<char>(number<T>() + 0x10);
  else
    return static_cast<char>(0x60 + sizeof(T) % 0x10);
}
inline constexpr char text = 0x70, each = 0x71;
}  // namespace packed_kind

/// Writes values to a sequence of bytes.
class Packer {
 public:
  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const T& value)
  {
    bytes_.push_back(packed_kind::number<T>());
    append(&value, sizeof(T));
  }
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const std::vector<T>& values)
  {
    begin(packed_kind::sequence<T>(), values.size());
    append(values.data(), values.size() * sizeof(T));
  }
  template <typename T, std::size_t N>
  requires std::is_arithmetic_v<T>
  void operator()(const std::array<T, N>& values)
  {
    begin(packed_kind::sequence<T>(), N);
    append(values.data(), sizeof(values));
  }
  void operator()(const std::string& text)
  {
    begin(packed_kind::text, text.size());
    append(text.data(), text.size());
  }
  /// Writes each of the values by `transfer(packer, value)`.
  template <typename T>
  void each(const std::vector<T>& values, auto&& transfer)
  {
    begin(packed_kind::each, values.size());
    for (const T& value : values) transfer(*this, value);
  }
  template <typename T>
  void operator()(const std::optional<T>& value)
  {
    (*this)(value.has_value());
    if (value) (*this)(*value);
  }
  void all(const auto&... values) { ((*this)(values), ...); }
  /// Writes a value that is there by `transfer(packer, value)`.
  template <typename T>
  void optional(const std::optional<T>& value, auto&& transfer)
  {
    (*this)(value.has_value());
    if (value) transfer(*this, *value);
  }
  const std::vector<char>& bytes() const { return bytes_; }

 private:
  void begin(char kind, std::size_t n)
  {
    bytes_.push_back(kind);
    append(&n, sizeof(n));
  }
  void append(const void* from, std::size_t n)
  {
    const std::size_t end = bytes_.size();
    bytes_.resize(end + n);
    if (n > 0) std::memcpy(bytes_.data() + end, from, n);
  }
  std::vector<char> bytes_;
};

/// Reads the values of a Packer in the order in which they were written.
/// @throws chladni::Error when the bytes end too early, or another kind of value was written.
class Unpacker {
 public:
  explicit Unpacker(const std::vector<char>& bytes)
      : next_(bytes.data()), end_(bytes.data() + bytes.size())
  {}

  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(T& value)
  {
    expect(packed_kind::number<T>());
    extract(&value, sizeof(T));
  }
  void operator()(bool& value)
  {
    expect(packed_kind::number<bool>());
    char byte = 0;
    extract(&byte, 1);
    value = byte != 0;
  }
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(std::vector<T>& values)
  {
    values.resize(size(packed_kind::sequence<T>(), sizeof(T)));
    extract(values.data(), values.size() * sizeof(T));
  }
  template <typename T, std::size_t N>
  requires std::is_arithmetic_v<T>
  void operator()(std::array<T, N>& values)
  {
    if (size(packed_kind::sequence<T>(), sizeof(T)) != N) refuse();
    extract(values.data(), sizeof(values));
  }
  void operator()(std::string& text)
  {
    text.resize(size(packed_kind::text, 1));
    extract(text.data(), text.size());
  }
  template <typename T>
  void each(std::vector<T>& values, auto&& transfer)
  {
    values.resize(size(packed_kind::each, 1));
    for (T& value : values) transfer(*this, value);
  }
  template <typename T>
  void operator()(std::optional<T>& value)
  {
    bool is_there = false;
    (*this)(is_there);
    value.reset();
    if (is_there) (*this)(value.emplace());
  }
  void all(auto&... values) { ((*this)(values), ...); }
  template <typename T>
  void optional(std::optional<T>& value, auto&& transfer)
  {
    bool is_there = false;
    (*this)(is_there);
    value.reset();
    if (is_there) transfer(*this, value.emplace());
  }
  bool at_end() const { return next_ == end_; }

 private:
  void expect(char kind)
  {
    char found = 0;
    extract(&found, 1);
    if (found != kind) refuse();
  }
  /// Reads a number of values of a kind, each of which takes at least `bytes_of_each`.
  std::size_t size(char kind, std::size_t bytes_of_each)
  {
    expect(kind);
    std::size_t n = 0;
    extract(&n, sizeof(n));
    if (n > static_cast<std::size_t>(end_ - next_) / bytes_of_each) refuse();
    return n;
  }
  void extract(void* to, std::size_t n)
  {
    if (n > static_cast<std::size_t>(end_ - next_)) refuse();
    if (n > 0) std::memcpy(to, next_, n);
    next_ += n;
  }
  [[noreturn]] static void refuse()
  {
    throw Error(
        "what another process said is not whole, or its program is of another build; build or "
        "install all programs of Chladni together");
  }

  const char* next_;
  const char* end_;
};

}  // namespace chladni
