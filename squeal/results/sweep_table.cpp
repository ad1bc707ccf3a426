#include "squeal/results/sweep_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mbs_export/files/body_files.hpp"

namespace chladni::squeal {

using files::Reader, files::Writer;

std::size_t SweepTable::count(VariantState state) const
{
  return static_cast<std::size_t>(std::ranges::count(states, state));
}

SweepTable empty_sweep(std::vector<std::string> keys, files::RowMajorMatrix values,
                       std::vector<SweepColumn> columns)
{
  const Eigen::Index n = values.rows(), m = std::ssize(columns);
  return {.keys = std::move(keys),
          .values = std::move(values),
          .columns = std::move(columns),
          .results = files::RowMajorMatrix::Zero(n, m),
          .known = files::IntegerMatrix::Zero(n, m),
          .states = std::vector<VariantState>(static_cast<std::size_t>(n), VariantState::to_do),
          .failures = std::vector<std::string>(static_cast<std::size_t>(n)),
          .inputs = {}};
}

std::string name_of_variant(const SweepTable& sweep, std::size_t i)
{
  std::string name;
  for (std::size_t k = 0; k < sweep.keys.size(); ++k) {
    const double value = sweep.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
    name += fmt::format("{}{} = {}", k == 0 ? "" : ", ", sweep.keys[k], value);
  }
  return name;
}

namespace {

constexpr std::int64_t sweep_version = 1;

void write_failures(Writer& file, const SweepTable& sweep)
{
  std::vector<std::int64_t> variants;
  std::vector<std::string> reasons;
  for (std::size_t i = 0; i < sweep.n_variants(); ++i) {
    if (sweep.failures[i].empty()) continue;
    variants.push_back(static_cast<std::int64_t>(i) + 1);
    reasons.push_back(sweep.failures[i]);
  }
  if (variants.empty()) return;
  file.write("failures/variants", std::span<const std::int64_t>(variants), "1");
  file.write("failures/reasons", reasons);
}

void read_failures(const Reader& file, SweepTable& sweep)
{
  if (!file.contains("failures/variants")) return;
  const std::vector<std::string> reasons = file.texts("failures/reasons");
  const auto variants = file.integers("failures/variants", std::ssize(reasons));
  for (std::size_t i = 0; i < variants.size(); ++i) {
    if (variants[i] < 1 || variants[i] > std::ssize(sweep.failures))
      file.fail("failures/variants", "there is no such variant");
    sweep.failures[static_cast<std::size_t>(variants[i] - 1)] = reasons[i];
  }
}

std::vector<SweepColumn> read_columns(const Reader& file)
{
  const std::vector<std::string> names = file.texts("columns/names");
  const std::vector<std::string> units = file.texts("columns/units");
  if (units.size() != names.size()) file.fail("columns/units", "expected one for each name");
  std::vector<SweepColumn> columns;
  for (std::size_t i = 0; i < names.size(); ++i) columns.push_back({names[i], units[i]});
  return columns;
}

/// In quotes where it has to be.
std::string cell(const std::string& text)
{
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  quoted += '"';
  return quoted;
}

}  // namespace

void write_sweep(const std::filesystem::path& path, const SweepTable& sweep,
                 const mbs_export::Provenance& provenance)
{
  Writer file(path.string());
  file.attribute("/", "format", sweep_format);
  file.attribute("/", "version", sweep_version);
  mbs_export::file_parts::write_provenance(file, provenance);
  file.write("inputs", sweep.inputs);
  file.write("keys", sweep.keys);
  file.write("values", sweep.values, "1");
  std::vector<std::string> names, units;
  for (const SweepColumn& column : sweep.columns) {
    names.push_back(column.name);
    units.push_back(column.unit);
  }
  file.write("columns/names", names);
  file.write("columns/units", units);
  file.write("results", sweep.results, "1");
  file.write("known", sweep.known, "1");
  std::vector<std::int64_t> states;
  for (const VariantState state : sweep.states) states.push_back(static_cast<std::int64_t>(state));
  file.write("states", std::span<const std::int64_t>(states), "1");
  write_failures(file, sweep);
  file.commit();
}

SweepTable read_sweep(const Reader& file)
{
  file.expect_format(sweep_format, sweep_version);
  const std::vector<std::string> keys = file.texts("keys");
  const Eigen::MatrixXd values = file.matrix("values", {files::any, std::ssize(keys)});
  SweepTable sweep = empty_sweep(keys, values, read_columns(file));
  const files::Shape shape{values.rows(), std::ssize(sweep.columns)};
  sweep.results = file.matrix("results", shape);
  sweep.known = file.integer_matrix("known", shape);
  const auto states = file.integers("states", values.rows());
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i] < 0 || states[i] > 2) file.fail("states", "expected 0, 1 or 2");
    sweep.states[i] = static_cast<VariantState>(states[i]);
  }
  read_failures(file, sweep);
  sweep.inputs = file.text("inputs");
  return sweep;
}

std::string csv_of(const SweepTable& sweep)
{
  std::string text = "variant";
  for (const std::string& key : sweep.keys) text += fmt::format(",{}", cell(key));
  for (const SweepColumn& column : sweep.columns) text += fmt::format(",{}", cell(column.name));
  text += ",failure\n";
  for (std::size_t i = 0; i < sweep.n_variants(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    text += fmt::format("{}", i + 1);
    for (const double value : sweep.values.row(row)) text += fmt::format(",{}", value);
    for (Eigen::Index j = 0; j < sweep.results.cols(); ++j)
      text += sweep.known(row, j) ? fmt::format(",{}", sweep.results(row, j)) : std::string(",");
    text += fmt::format(",{}\n", cell(sweep.failures[i]));
  }
  return text;
}

}  // namespace chladni::squeal
