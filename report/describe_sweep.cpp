#include "report/describe_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>

namespace chladni::report {
namespace {

using squeal::VariantState;

/// The least and the largest of the numbers of a column that are known.
struct Range {
  std::size_t n = 0;
  double least = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();

  void add(double x)
  {
    ++n;
    least = std::min(least, x);
    largest = std::max(largest, x);
  }
};

std::vector<std::string> row_of(const std::string& name, const Range& range)
{
  if (range.n == 0) return {name, "", "", "0"};
  return {name, fmt::format("{:.6g}", range.least), fmt::format("{:.6g}", range.largest),
          fmt::format("{}", range.n)};
}

Range range_of(const squeal::SweepTable& sweep, Eigen::Index column)
{
  Range range;
  for (Eigen::Index i = 0; i < sweep.results.rows(); ++i)
    if (sweep.known(i, column)) range.add(sweep.results(i, column));
  return range;
}

void add_failures(TextTable& table, const squeal::SweepTable& sweep)
{
  constexpr std::size_t most = 20;
  std::size_t told = 0;
  for (std::size_t i = 0; i < sweep.n_variants(); ++i) {
    if (sweep.failures[i].empty() || ++told > most) continue;
    table.rows.push_back({fmt::format("variant {}: {}: {}", i + 1, name_of_variant(sweep, i),
                                      printable(sweep.failures[i])),
                          "", "", ""});
  }
  if (told > most)
    table.rows.push_back({fmt::format("and {} more that failed", told - most), "", "", ""});
}

}  // namespace

TextTable describe(const squeal::SweepTable& sweep)
{
  TextTable table{.header = {"", "least", "largest", "variants"}, .rows = {}};
  for (std::size_t k = 0; k < sweep.keys.size(); ++k) {
    Range range;
    for (const double value : sweep.values.col(static_cast<Eigen::Index>(k))) range.add(value);
    table.rows.push_back(row_of(printable(sweep.keys[k]), range));
  }
  for (std::size_t j = 0; j < sweep.columns.size(); ++j) {
    table.rows.push_back(
        row_of(printable(sweep.columns[j].name), range_of(sweep, static_cast<Eigen::Index>(j))));
  }
  const auto count = [&](const char* name, VariantState state) {
    if (const std::size_t n = sweep.count(state))
      table.rows.push_back({name, "", "", fmt::format("{}", n)});
  };
  count("done", VariantState::done);
  count("failed", VariantState::failed);
  count("still to do: squeal sweep --resume", VariantState::to_do);
  add_failures(table, sweep);
  return table;
}

std::vector<Json::Member> sweep_json(const squeal::SweepTable& sweep)
{
  std::vector<Json> failures;
  for (std::size_t i = 0; i < sweep.n_variants(); ++i) {
    if (sweep.failures[i].empty()) continue;
    failures.push_back(Json::object(
        {{"variant", i + 1}, {"of", name_of_variant(sweep, i)}, {"reason", sweep.failures[i]}}));
  }
  return {{"variants", sweep.n_variants()},
          {"done", sweep.count(VariantState::done)},
          {"failed", sweep.count(VariantState::failed)},
          {"failures", Json::array(failures)}};
}

}  // namespace chladni::report
