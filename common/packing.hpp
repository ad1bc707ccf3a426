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

/// Values as a sequence of bytes, between processes of one program on one machine.
namespace chladni {

/// Writes values to a sequence of bytes.
class Packer {
 public:
  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const T& value) { append(&value, sizeof(T)); }
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const std::vector<T>& values)
  {
    (*this)(values.size());
    append(values.data(), values.size() * sizeof(T));
  }
  template <typename T, std::size_t N>
  requires std::is_arithmetic_v<T>
  void operator()(const std::array<T, N>& values) { append(values.data(), sizeof(values)); }
  void operator()(const std::string& text)
  {
    (*this)(text.size());
    append(text.data(), text.size());
  }
  /// Writes each of the values by `transfer(packer, value)`.
  template <typename T>
  void each(const std::vector<T>& values, auto&& transfer)
  {
    (*this)(values.size());
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
  void append(const void* from, std::size_t n)
  {
    const std::size_t end = bytes_.size();
    bytes_.resize(end + n);
    if (n > 0) std::memcpy(bytes_.data() + end, from, n);
  }
  std::vector<char> bytes_;
};

/// Reads the values of a Packer in the order in which they were written.
/// @throws chladni::Error when the bytes end too early.
class Unpacker {
 public:
  explicit Unpacker(const std::vector<char>& bytes)
      : next_(bytes.data()), end_(bytes.data() + bytes.size())
  {}

  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(T& value) { extract(&value, sizeof(T)); }
  void operator()(bool& value)
  {
    char byte = 0;
    extract(&byte, 1);
    value = byte != 0;
  }
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(std::vector<T>& values)
  {
    values.resize(size(sizeof(T)));
    extract(values.data(), values.size() * sizeof(T));
  }
  template <typename T, std::size_t N>
  requires std::is_arithmetic_v<T>
  void operator()(std::array<T, N>& values) { extract(values.data(), sizeof(values)); }
  void operator()(std::string& text)
  {
    text.resize(size(1));
    extract(text.data(), text.size());
  }
  template <typename T>
  void each(std::vector<T>& values, auto&& transfer)
  {
    values.resize(size(1));
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
  /// Reads a number of values, each of which takes at least `bytes_of_each`.
  std::size_t size(std::size_t bytes_of_each)
  {
    std::size_t n = 0;
    (*this)(n);
    if (n > static_cast<std::size_t>(end_ - next_) / bytes_of_each) refuse();
    return n;
  }
  void extract(void* to, std::size_t n)
  {
    if (n > static_cast<std::size_t>(end_ - next_)) refuse();
    if (n > 0) std::memcpy(to, next_, n);
    next_ += n;
  }
  [[noreturn]] static void refuse() { throw Error("the bytes of another process are not whole"); }

  const char* next_;
  const char* end_;
};

}  // namespace chladni
