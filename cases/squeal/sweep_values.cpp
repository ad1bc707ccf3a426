#include "cases/squeal/sweep_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

#include "common/error.hpp"

namespace chladni::cases {
namespace {

std::string_view trimmed(std::string_view text)
{
  const std::size_t from = text.find_first_not_of(" \t\r");
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

std::vector<std::string_view> parts_of(std::string_view text, char separator)
{
  std::vector<std::string_view> parts;
  for (std::size_t at = text.find(separator); at != std::string_view::npos;
       at = text.find(separator)) {
    parts.push_back(trimmed(text.substr(0, at)));
    text.remove_prefix(at + 1);
  }
  parts.push_back(trimmed(text));
  return parts;
}

std::optional<double> finite_number(std::string_view text)
{
  double x = 0.0;
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc{} || rest != text.data() + text.size() || !std::isfinite(x))
    return std::nullopt;
  return x;
}

/// The numbers of "FROM:TO:COUNT" or "VALUE,VALUE,..."; nothing for any other text.
std::optional<std::vector<double>> values_of(std::string_view text)
{
  const bool is_range = text.find(':') != std::string_view::npos;
  std::vector<double> values;
  for (const std::string_view part : parts_of(text, is_range ? ':' : ',')) {
    const std::optional<double> x = finite_number(part);
    if (!x) return std::nullopt;
    values.push_back(*x);
  }
  if (!is_range) return values;
  if (values.size() != 3 || !(values[2] >= 1.0) || values[2] != std::floor(values[2]) ||
      values[2] > variants_max)
    return std::nullopt;
  const Eigen::VectorXd spaced =
      Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(values[2]), values[0], values[1]);
  return std::vector<double>(spaced.begin(), spaced.end());
}

void refuse_twice(const std::vector<std::string>& keys, const std::string& place)
{
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (std::ranges::count(keys, keys[i]) > 1)
      throw Error(fmt::format("{}: {} is there twice", place, keys[i]));
}

std::vector<double> row_of(std::string_view line, std::size_t n_keys, const std::string& place)
{
  const std::vector<std::string_view> cells = parts_of(line, ',');
  if (cells.size() != n_keys)
    throw Error(fmt::format("{}: has {} numbers for {} keys", place, cells.size(), n_keys));
  std::vector<double> row;
  for (const std::string_view cell : cells) {
    const std::optional<double> x = finite_number(cell);
    if (!x) throw Error(fmt::format("{}: \"{}\" is no finite number", place, cell));
    row.push_back(*x);
  }
  return row;
}

/// The grid of the axes, the last one fastest.
files::RowMajorMatrix product(const std::vector<std::vector<double>>& axes, std::size_t n)
{
  files::RowMajorMatrix values(static_cast<Eigen::Index>(n), std::ssize(axes));
  std::size_t period = n;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    period /= axes[k].size();
    for (std::size_t i = 0; i < n; ++i) {
      values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          axes[k][i / period % axes[k].size()];
    }
  }
  return values;
}

}  // namespace

SweepValues sweep_grid(const std::vector<std::string>& words)
{
  SweepValues sweep;
  std::vector<std::vector<double>> axes;
  double n = 1.0;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string key(trimmed(std::string_view(word).substr(0, equals)));
    std::optional<std::vector<double>> values;
    if (equals != std::string::npos) values = values_of(std::string_view(word).substr(equals + 1));
    if (key.empty() || !values) {
      throw Error(
          fmt::format("--vary {}: give KEY=FROM:TO:COUNT or KEY=VALUE,VALUE,..., as in "
                      "squeal.friction=0.3:0.6:10",
                      word));
    }
    n *= double(values->size());
    sweep.keys.push_back(key);
    axes.push_back(std::move(*values));
  }
  refuse_twice(sweep.keys, "--vary");
  if (n > variants_max)
    throw Error(fmt::format("--vary: {:.0f} variants; at most {:.0f}", n, variants_max));
  sweep.values = product(axes, static_cast<std::size_t>(n));
  return sweep;
}

SweepValues read_samples(const std::string& file)
{
  std::ifstream stream(file);
  std::string line;
  if (!stream || !std::getline(stream, line)) {
    throw Error(
        fmt::format("{}: cannot be read; give a file whose first line is keys of the scene, "
                    "separated by commas, and whose others are numbers",
                    file));
  }
  SweepValues sweep;
  for (const std::string_view key : parts_of(line, ',')) sweep.keys.emplace_back(key);
  refuse_twice(sweep.keys, file + ":1");
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 2; std::getline(stream, line); ++i) {
    if (trimmed(line).empty()) continue;
    rows.push_back(row_of(line, sweep.keys.size(), fmt::format("{}:{}", file, i)));
    if (double(rows.size()) > variants_max)
      throw Error(fmt::format("{}: more than {:.0f} variants", file, variants_max));
  }
  if (rows.empty()) throw Error(fmt::format("{}: has keys, but no line of numbers", file));
  sweep.values.resize(std::ssize(rows), std::ssize(sweep.keys));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    sweep.values.row(static_cast<Eigen::Index>(i)) =
        Eigen::RowVectorXd::Map(rows[i].data(), std::ssize(rows[i]));
  }
  return sweep;
}

}  // namespace chladni::cases
