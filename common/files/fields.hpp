#pragma once

#include <fmt/format.h>

#include <Eigen/Core>

#include <complex>
#include <concepts>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/files/hdf5.hpp"

/// Structs as groups of an HDF5 file. One list of fields for each stored struct says name, unit and
/// place of every dataset; writing, reading, comparing and JSON follow from it:
///   double, int (a count), std::int64_t, bool, text, lists of texts, vectors, matrices: a dataset
///   complex vectors and matrices: NAME_re and NAME_im, of the unit "1/s + i rad/s" or one for both
///   std::optional<double>: a dataset that may be absent
///   another stored struct: a group; std::optional of one: a group that may be absent
///   a vector of stored structs: a group with one dataset for each member, in which -1 stands for
///   what is absent; or, of `Numbered` structs, groups 1, 2, ...
namespace chladni::files {

enum class Presence {
  always,
  later,  ///< always written, but not by earlier versions: the member keeps its initial value
  if_any  ///< written if it is not empty
};

/// One member of a stored struct.
template <class Owner, class Value>
struct Field {
  const char* name;  ///< of the dataset or group within the group of the struct
  const char* unit;  ///< "own": that of the struct, which its user states
  Value Owner::*member;
  const char* shape = "";  ///< "n_t x n_f": extents of one name are equal within the struct
  Presence presence = Presence::always;
  /// Refuses values that later code could not use.
  void (*check)(const Reader& file, const std::string& name, const Value& x) = nullptr;
  const char* key = "";  ///< in JSON; "": the name with the unit, "pad_velocity_m_s"
};
template <class Owner, class Value, class... Rest>
Field(const char*, const char*, Value Owner::*, Rest...) -> Field<Owner, Value>;

/// A struct T whose namespace has `fields_of(std::type_identity<T>)`: its list, a tuple of Field.
template <class T>
concept Stored = requires
{
  fields_of(std::type_identity<T>{});
};

/// A stored struct T whose namespace declares `void are_numbered(std::type_identity<T>)`: vectors
/// of it are stored in groups 1, 2, ..., not as a dataset for each member.
template <class T>
concept Numbered = Stored<T> && requires
{
  are_numbered(std::type_identity<T>{});
};

/// Calls f(field) for each field of a stored struct.
template <Stored T, class F>
void for_each_field(F&& f)
{
  std::apply([&](const auto&... field) { (f(field), ...); }, fields_of(std::type_identity<T>{}));
}

namespace in_fields {

template <class T>
inline constexpr bool is_vector_of_stored = false;
template <Stored T>
inline constexpr bool is_vector_of_stored<std::vector<T>> = true;

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;
template <class T>
inline constexpr bool is_optional_stored = false;
template <Stored T>
inline constexpr bool is_optional_stored<std::optional<T>> = true;

template <class T>
inline constexpr bool is_complex = false;
template <int rows, int cols>
inline constexpr bool is_complex<Eigen::Matrix<std::complex<double>, rows, cols>> = true;

template <class T>
concept Integer = std::same_as<T, int> || std::same_as<T, bool> || std::same_as<T, std::int64_t>;

inline std::string joined(const std::string& group, const std::string& name)
{
  return group.empty() ? name : name.empty() ? group : group + '/' + name;
}

inline std::string unit_within(const char* unit, const std::string& own)
{
  return unit == std::string_view("own") ? own : unit;
}

/// Units of real and imaginary parts.
inline std::pair<std::string, std::string> units_of_parts(const std::string& unit)
{
  const auto plus = unit.find(" + i ");
  if (plus == std::string::npos) return {unit, unit};
  return {unit.substr(0, plus), unit.substr(plus + 5)};
}

template <class T>
bool is_empty(const T& x)
{
  if constexpr (requires { x.empty(); })
    return x.empty();
  else if constexpr (requires { x.size(); })
    return x.size() == 0;
  else
    return false;
}

/// Extents of a struct by their names, known from the first dataset that has them.
class Extents {
 public:
  Shape expected(std::string_view shape) const
  {
    const auto [rows, cols] = names(shape);
    return {known(rows), known(cols)};
  }
  void learn(std::string_view shape, Eigen::Index rows, Eigen::Index cols)
  {
    const auto [of_rows, of_cols] = names(shape);
    known_.emplace(of_rows, rows);
    known_.emplace(of_cols, cols);
  }

 private:
  static std::pair<std::string, std::string> names(std::string_view shape)
  {
    const auto times = shape.find(" x ");
    if (times == std::string_view::npos) return {std::string(shape), std::string()};
    return {std::string(shape.substr(0, times)), std::string(shape.substr(times + 3))};
  }
  Eigen::Index known(const std::string& name) const
  {
    const auto at = known_.find(name);
    return name.empty() || at == known_.end() ? any : at->second;
  }

  std::map<std::string, Eigen::Index> known_;
};

/// @param n  required number; `any`
inline std::vector<std::string> texts_in(const Reader& file, const std::string& name,
                                         Eigen::Index n)
{
  std::vector<std::string> texts = file.texts(name);
  if (n != any && std::ssize(texts) != n)
    file.fail(name, fmt::format("has {} values, expected {}", texts.size(), n));
  return texts;
}

inline int count_in(const Reader& file, const std::string& name, std::int64_t x)
{
  if (x < 0 || x > std::numeric_limits<int>::max())
    file.fail(name, fmt::format("is {}, expected a count", x));
  return static_cast<int>(x);
}

}  // namespace in_fields

/// Reads counts, such as 1-based numbers of modes.
inline std::vector<int> read_counts(const Reader& file, const std::string& name,
                                    Eigen::Index size = any)
{
  constexpr std::int64_t largest = std::numeric_limits<int>::max() - 1;
  std::vector<int> counts;
  for (const std::int64_t i : file.integers(name, size)) {
    if (i < 0 || i > largest)
      file.fail(name, fmt::format("has the index {}, expected 0 .. {}", i, largest));
    counts.push_back(static_cast<int>(i));
  }
  return counts;
}

/// Writes rows as one dataset for each member. `at(i)` is the row i.
template <Stored Row, class At>
void write_columns(Writer& file, const std::string& group, std::size_t n, const std::string& own,
                   const At& at)
{
  for_each_field<Row>([&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(std::declval<Row>().*field.member)>;
    const std::string name = in_fields::joined(group, field.name);
    const std::string unit = in_fields::unit_within(field.unit, own);
    if constexpr (Stored<Value>) {
      write_columns<Value>(file, name, n, unit,
                           [&](std::size_t i) -> const Value& { return at(i).*field.member; });
    } else if constexpr (std::same_as<Value, std::string>) {
      std::vector<std::string> texts;
      for (std::size_t i = 0; i < n; ++i) texts.push_back(at(i).*field.member);
      file.write(name, texts);
    } else {
      constexpr bool is_real =
          std::same_as<Value, double> || std::same_as<Value, std::optional<double>>;
      using Number = std::conditional_t<is_real, double, std::int64_t>;
      std::vector<Number> x;
      for (std::size_t i = 0; i < n; ++i) {
        const Value& value = at(i).*field.member;
        if constexpr (in_fields::is_optional<Value>)
          x.push_back(static_cast<Number>(value.value_or(-1)));
        else
          x.push_back(static_cast<Number>(value));
      }
      file.write(name, std::span<const Number>(x), unit);
    }
  });
}

/// How many rows there are, which each column must have: before memory for rows is taken, since a
/// small file may hold one long column alone.
/// @param n  `any`, or the number that other columns have
template <Stored Row>
Eigen::Index count_rows(const Reader& file, const std::string& group, Eigen::Index n = any)
{
  for_each_field<Row>([&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(std::declval<Row>().*field.member)>;
    const std::string name = in_fields::joined(group, field.name);
    if (field.presence == Presence::later && !file.contains(name)) return;
    if constexpr (Stored<Value>)
      n = count_rows<Value>(file, name, n);
    else if constexpr (std::same_as<Value, std::string>)
      n = std::ssize(in_fields::texts_in(file, name, n));
    else if constexpr (std::same_as<Value, double> || std::same_as<Value, std::optional<double>>)
      n = file.vector(name, n).size();
    else
      n = std::ssize(file.integers(name, n));
  });
  return n;
}

/// Reads n rows of what `write_columns` writes.
/// @param at   `at(i)` is the row i
template <Stored Row, class At>
void read_columns(const Reader& file, const std::string& group, Eigen::Index n, const At& at)
{
  for_each_field<Row>([&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(std::declval<Row>().*field.member)>;
    const std::string name = in_fields::joined(group, field.name);
    if (field.presence == Presence::later && !file.contains(name)) return;
    const auto take = [&](const auto& x) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
        Value& value = at(i).*field.member;
        const auto number = x[i];
        if constexpr (in_fields::is_optional<Value>) {
          if (number >= 0) value = static_cast<typename Value::value_type>(number);
        } else if constexpr (std::same_as<Value, int>) {
          value = in_fields::count_in(file, name, number);
        } else {
          value = static_cast<Value>(number);
        }
      }
    };
    if constexpr (Stored<Value>) {
      read_columns<Value>(file, name, n,
                          [&](std::size_t i) -> Value& { return at(i).*field.member; });
    } else if constexpr (std::same_as<Value, std::string>) {
      std::vector<std::string> texts = in_fields::texts_in(file, name, n);
      for (std::size_t i = 0; i < texts.size(); ++i) at(i).*field.member = std::move(texts[i]);
    } else if constexpr (std::same_as<Value, double> ||
                         std::same_as<Value, std::optional<double>>) {
      const Eigen::VectorXd x = file.vector(name, n);
      take(std::span<const double>(x.data(), static_cast<std::size_t>(x.size())));
    } else {
      take(file.integers(name, n));
    }
  });
}

template <Stored Row>
void write_rows(Writer& file, const std::string& group, const std::vector<Row>& rows,
                const std::string& own = "")
{
  write_columns<Row>(file, group, rows.size(), own,
                     [&](std::size_t i) -> const Row& { return rows[i]; });
}

/// @param n  required number of rows
template <Stored Row>
std::vector<Row> read_rows(const Reader& file, const std::string& group, Eigen::Index n = any)
{
  if (n == any) n = count_rows<Row>(file, group);
  std::vector<Row> rows(static_cast<std::size_t>(n));
  read_columns<Row>(file, group, n, [&](std::size_t i) -> Row& { return rows[i]; });
  return rows;
}

/// Writes a struct as a group; "" is the root.
/// @param own  unit of its fields of the unit "own"
template <Stored T>
void write_fields(Writer& file, const std::string& group, const T& x, const std::string& own = "");

/// Reads what `write_fields` writes.
/// @throws chladni::Error naming file and dataset, when something is missing, has a wrong size or
///         is not finite.
template <Stored T>
T read_fields(const Reader& file, const std::string& group);

namespace in_fields {

template <class Value>
void write_value(Writer& file, const std::string& name, const Value& x, const std::string& unit)
{
  if constexpr (std::same_as<Value, std::string> || std::same_as<Value, std::vector<std::string>>) {
    file.write(name, x);
  } else if constexpr (Integer<Value>) {
    file.write(name, std::int64_t{x}, unit);
  } else if constexpr (is_optional<Value>) {
    if (x) file.write(name, *x, unit);
  } else if constexpr (std::same_as<Value, std::vector<int>>) {
    file.write(name, std::span<const int>(x), unit);
  } else if constexpr (is_complex<Value>) {
    const auto [of_re, of_im] = units_of_parts(unit);
    file.write(name + "_re", x.real(), of_re);
    file.write(name + "_im", x.imag(), of_im);
  } else {
    file.write(name, x, unit);
  }
}

inline Eigen::VectorXd sized(const Reader& file, const std::string& name, std::string_view shape,
                             Extents& extents)
{
  Eigen::VectorXd x = file.vector(name, extents.expected(shape).rows);
  extents.learn(shape, x.size(), 1);
  return x;
}

inline Eigen::MatrixXd sized_matrix(const Reader& file, const std::string& name,
                                    std::string_view shape, Extents& extents)
{
  Eigen::MatrixXd x = file.matrix(name, extents.expected(shape));
  extents.learn(shape, x.rows(), x.cols());
  return x;
}

template <class Value>
Value read_value(const Reader& file, const std::string& name, std::string_view shape,
                 Extents& extents)
{
  if constexpr (std::same_as<Value, double>) {
    return file.real(name);
  } else if constexpr (std::same_as<Value, std::optional<double>>) {
    return file.contains(name) ? std::optional(file.real(name)) : std::nullopt;
  } else if constexpr (std::same_as<Value, std::string>) {
    return file.text(name);
  } else if constexpr (std::same_as<Value, std::vector<std::string>>) {
    return file.texts(name);
  } else if constexpr (std::same_as<Value, int>) {
    return count_in(file, name, file.integer(name));
  } else if constexpr (std::same_as<Value, bool>) {
    return file.integer(name) != 0;
  } else if constexpr (std::same_as<Value, std::int64_t>) {
    return file.integer(name);
  } else if constexpr (std::same_as<Value, Eigen::VectorXd>) {
    return sized(file, name, shape, extents);
  } else if constexpr (std::same_as<Value, std::vector<double>>) {
    const Eigen::VectorXd x = sized(file, name, shape, extents);
    return {x.begin(), x.end()};
  } else if constexpr (std::same_as<Value, std::vector<int>>) {
    std::vector<int> x = read_counts(file, name, extents.expected(shape).rows);
    extents.learn(shape, std::ssize(x), 1);
    return x;
  } else if constexpr (std::same_as<Value, Eigen::MatrixXd>) {
    return sized_matrix(file, name, shape, extents);
  } else if constexpr (is_complex<Value>) {
    // An unnamed shape is that of the real part.
    const auto parts = [&](auto&& read) {
      const auto re = read("_re", shape, extents);
      Extents of_re;
      of_re.learn("m x n", re.rows(), re.cols());
      const auto im = read("_im", Value::IsVectorAtCompileTime ? "m" : "m x n", of_re);
      return Value(re + std::complex<double>(0.0, 1.0) * im);
    };
    if constexpr (Value::IsVectorAtCompileTime)
      return parts([&](const char* part, std::string_view of, Extents& known) {
        return sized(file, name + part, of, known);
      });
    else
      return parts([&](const char* part, std::string_view of, Extents& known) {
        return sized_matrix(file, name + part, of, known);
      });
  }
}

/// Whether a field has something in the file.
template <class Value>
bool is_there(const Reader& file, const std::string& name)
{
  return file.contains(is_complex<Value> ? name + "_re" : name);
}

}  // namespace in_fields

template <Stored T>
void write_fields(Writer& file, const std::string& group, const T& x, const std::string& own)
{
  for_each_field<T>([&](const auto& field) {
    const auto& value = x.*field.member;
    using Value = std::remove_cvref_t<decltype(value)>;
    if (field.presence == Presence::if_any && in_fields::is_empty(value)) return;
    const std::string name = in_fields::joined(group, field.name);
    const std::string unit = in_fields::unit_within(field.unit, own);
    if constexpr (Stored<Value>) {
      write_fields(file, name, value, unit);
    } else if constexpr (in_fields::is_optional_stored<Value>) {
      if (value) write_fields(file, name, *value, unit);
    } else if constexpr (in_fields::is_vector_of_stored<Value>) {
      if constexpr (Numbered<typename Value::value_type>)
        for (std::size_t i = 0; i < value.size(); ++i)
          write_fields(file, fmt::format("{}/{}", name, i + 1), value[i], unit);
      else
        write_rows(file, name, value, unit);
    } else {
      in_fields::write_value(file, name, value, unit);
    }
  });
}

template <Stored T>
T read_fields(const Reader& file, const std::string& group)
{
  T x{};
  in_fields::Extents extents;
  for_each_field<T>([&](const auto& field) {
    auto& value = x.*field.member;
    using Value = std::remove_cvref_t<decltype(value)>;
    const std::string name = in_fields::joined(group, field.name);
    if (field.presence != Presence::always && !in_fields::is_there<Value>(file, name)) return;
    if constexpr (Stored<Value>) {
      value = read_fields<Value>(file, name);
    } else if constexpr (in_fields::is_optional_stored<Value>) {
      if (file.contains(name)) value = read_fields<typename Value::value_type>(file, name);
    } else if constexpr (in_fields::is_vector_of_stored<Value>) {
      using Row = typename Value::value_type;
      if constexpr (Numbered<Row>)
        for (int i = 1; file.contains(fmt::format("{}/{}", name, i)); ++i)
          value.push_back(read_fields<Row>(file, fmt::format("{}/{}", name, i)));
      else
        value = read_rows<Row>(file, name);
    } else {
      value = in_fields::read_value<Value>(file, name, field.shape, extents);
    }
    if (field.check) field.check(file, name, value);
  });
  return x;
}

/// The names of the fields in which two structs differ, separated by blanks; empty: none.
template <class T>
std::string difference(const T& a, const T& b, const std::string& name = "")
{
  std::string found;
  if constexpr (Stored<T>) {
    for_each_field<T>([&](const auto& field) {
      found += difference(a.*field.member, b.*field.member, in_fields::joined(name, field.name));
    });
  } else if constexpr (in_fields::is_optional_stored<T>) {
    if (a.has_value() != b.has_value()) return name + ' ';
    if (a) found = difference(*a, *b, name);
  } else if constexpr (in_fields::is_vector_of_stored<T>) {
    if (a.size() != b.size()) return name + " (number) ";
    for (std::size_t i = 0; i < a.size(); ++i)
      found += difference(a[i], b[i], fmt::format("{}[{}]", name, i));
  } else {
    bool is_equal = true;
    if constexpr (requires { a.rows(); }) is_equal = a.rows() == b.rows() && a.cols() == b.cols();
    if (!is_equal || !(a == b)) found = name + ' ';
  }
  return found;
}

}  // namespace chladni::files
