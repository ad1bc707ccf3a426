// Eigen's product of three sparse matrices sorts each of its steps by two transpositions; here each
// row is summed once, and only what stands on and above the diagonal.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "cyclic/harmonic_coordinates.hpp"

namespace chladni::cyclic {

namespace {

/// The sum of sparse rows of one length.
class RowSum {
 public:
  explicit RowSum(Eigen::Index n) : value_(std::size_t(n)), row_(std::size_t(n), -1) {}

  void begin(int row)
  {
    current_ = row;
    columns_.clear();
  }

  void add(int column, double value)
  {
    const auto j = static_cast<std::size_t>(column);
    if (row_[j] == current_) {
      value_[j] += value;
      return;
    }
    row_[j] = current_;
    value_[j] = value;
    columns_.push_back(column);
  }

  std::vector<int>& columns() { return columns_; }
  double operator[](int column) const { return value_[std::size_t(column)]; }

 private:
  int current_ = -1;
  std::vector<double> value_;
  std::vector<int> row_;  ///< to which the value belongs
  std::vector<int> columns_;
};

/// Rows of a matrix one after the other, the columns of each in any order.
struct Rows {
  std::vector<std::size_t> start{0};
  std::vector<int> columns;
  std::vector<double> values;

  void push_back(const RowSum& sum, const std::vector<int>& of_row)
  {
    for (const int column : of_row) {
      columns.push_back(column);
      values.push_back(sum[column]);
    }
    start.push_back(columns.size());
  }
};

Rows product(const SparseRows& A, const SparseRows& T)
{
  Rows AT;
  RowSum sum(T.cols());
  for (int row = 0; row < A.outerSize(); ++row) {
    sum.begin(row);
    for (SparseRows::InnerIterator a(A, row); a; ++a)
      for (SparseRows::InnerIterator t(T, a.index()); t; ++t)
        sum.add(int(t.index()), a.value() * t.value());
    AT.push_back(sum, sum.columns());
  }
  return AT;
}

/// A phase and what a form makes of it.
struct Phase {
  SparseRows transposed;
  Rows of_form;
};

/// The sum over the phases T of T^T A T, on and above the diagonal, which comes first in its row.
Rows upper_triangle(const std::vector<Phase>& phases, Eigen::Index n)
{
  Rows upper;
  RowSum sum(n);
  for (int row = 0; row < n; ++row) {
    sum.begin(row);
    sum.add(row, 0.0);
    for (const auto& [transposed, AT] : phases) {
      for (SparseRows::InnerIterator t(transposed, row); t; ++t) {
        const auto k = static_cast<std::size_t>(t.index());
        for (std::size_t e = AT.start[k]; e < AT.start[k + 1]; ++e)
          if (AT.columns[e] >= row) sum.add(AT.columns[e], t.value() * AT.values[e]);
      }
    }
    upper.push_back(sum, sum.columns());
  }
  return upper;
}

/// The entries by column, rows ascending: the lower triangle. What is round-off beside the
/// diagonals is left out.
Rows transposed(const Rows& upper)
{
  constexpr double round_off = 1e-14;
  const auto n = upper.start.size() - 1;
  std::vector<double> scale(n);
  for (std::size_t i = 0; i < n; ++i) scale[i] = std::sqrt(std::abs(upper.values[upper.start[i]]));
  const auto for_entries = [&](const auto& visit) {
    for (std::size_t row = 0; row < n; ++row) {
      for (std::size_t e = upper.start[row]; e < upper.start[row + 1]; ++e) {
        const auto column = static_cast<std::size_t>(upper.columns[e]);
        const double least = round_off * scale[row] * scale[column];
        if (column == row || std::abs(upper.values[e]) > least) visit(row, column, upper.values[e]);
      }
    }
  };
  Rows lower;
  lower.start.assign(n + 1, 0);
  for_entries([&](std::size_t, std::size_t column, double) { ++lower.start[column + 1]; });
  std::partial_sum(lower.start.begin(), lower.start.end(), lower.start.begin());
  lower.columns.resize(lower.start.back());
  lower.values.resize(lower.start.back());
  std::vector<std::size_t> place(lower.start.begin(), lower.start.end() - 1);
  for_entries([&](std::size_t row, std::size_t column, double value) {
    const std::size_t at = place[column]++;
    lower.columns[at] = static_cast<int>(row);
    lower.values[at] = value;
  });
  return lower;
}

/// Both triangles of `factor` times the matrix, columns ascending without any sorting: a row has
/// its entries up to the diagonal at once, and the others from later rows in their order.
SparseRows symmetric(const Rows& lower, double factor)
{
  const auto n = static_cast<int>(lower.start.size()) - 1;
  std::vector<int> place(std::size_t(n) + 1, 0);
  for (std::size_t row = 0; row < std::size_t(n); ++row) {
    for (std::size_t e = lower.start[row]; e < lower.start[row + 1]; ++e) {
      ++place[row + 1];
      if (std::cmp_not_equal(lower.columns[e], row)) ++place[std::size_t(lower.columns[e]) + 1];
    }
  }
  std::partial_sum(place.begin(), place.end(), place.begin());
  SparseRows form(n, n);
  form.resizeNonZeros(place.back());
  std::ranges::copy(place, form.outerIndexPtr());
  const auto put = [&](int row, int column, double value) {
    const int at = place[std::size_t(row)]++;
    form.innerIndexPtr()[at] = column;
    form.valuePtr()[at] = factor * value;
  };
  for (int row = 0; row < n; ++row) {
    for (std::size_t e = lower.start[std::size_t(row)]; e < lower.start[std::size_t(row) + 1];
         ++e) {
      put(row, lower.columns[e], lower.values[e]);
      if (lower.columns[e] != row) put(lower.columns[e], row, lower.values[e]);
    }
  }
  return form;
}

}  // namespace

SparseRows harmonic_form(const SparseRows& A, const HarmonicCoordinates& c)
{
  std::vector<Phase> phases;
  for (const SparseRows* T : {&c.X, &c.Y})
    if (T->nonZeros() > 0) phases.push_back({SparseRows(T->transpose()), product(A, *T)});
  return symmetric(transposed(upper_triangle(phases, c.n())), c.weight);
}

}  // namespace chladni::cyclic
