// Eigen's product of three sparse matrices sorts each of its steps by two transpositions; here each
// row is summed once, and only what stands on and above the diagonal.
#include <algorithm>
#include <cmath>
#include <numeric>

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

/// The sum over the phases T of T^T A T, on and above the diagonal, columns ascending.
Rows upper_triangle(const std::vector<Phase>& phases, Eigen::Index n)
{
  Rows upper;
  RowSum sum(n);
  for (int row = 0; row < n; ++row) {
    sum.begin(row);
    for (const auto& [transposed, AT] : phases) {
      for (SparseRows::InnerIterator t(transposed, row); t; ++t) {
        const auto k = static_cast<std::size_t>(t.index());
        for (std::size_t e = AT.start[k]; e < AT.start[k + 1]; ++e)
          if (AT.columns[e] >= row) sum.add(AT.columns[e], t.value() * AT.values[e]);
      }
    }
    sum.add(row, 0.0);
    std::ranges::sort(sum.columns());
    upper.push_back(sum, sum.columns());
  }
  return upper;
}

/// visit(row, column, value) of what is no round-off beside the diagonals.
template <class Visit>
void for_entries(const Rows& upper, const Visit& visit)
{
  constexpr double round_off = 1e-14;
  const auto scale = [&](int i) {
    return std::sqrt(std::abs(upper.values[upper.start[std::size_t(i)]]));
  };
  const auto n = static_cast<int>(upper.start.size()) - 1;
  for (int row = 0; row < n; ++row) {
    const double of_row = round_off * scale(row);
    for (std::size_t e = upper.start[std::size_t(row)]; e < upper.start[std::size_t(row) + 1];
         ++e) {
      const int column = upper.columns[e];
      if (column == row || std::abs(upper.values[e]) > of_row * scale(column))
        visit(row, column, upper.values[e]);
    }
  }
}

/// Both triangles of `factor` times the matrix.
SparseRows symmetric(const Rows& upper, double factor)
{
  const auto n = static_cast<int>(upper.start.size()) - 1;
  std::vector<int> place(std::size_t(n) + 1, 0);
  for_entries(upper, [&](int row, int column, double) {
    ++place[std::size_t(row) + 1];
    if (column != row) ++place[std::size_t(column) + 1];
  });
  std::partial_sum(place.begin(), place.end(), place.begin());
  SparseRows form(n, n);
  form.resizeNonZeros(place.back());
  std::ranges::copy(place, form.outerIndexPtr());
  // Row by row: what is left of a diagonal comes from earlier rows, in their order.
  const auto put = [&](int row, int column, double value) {
    const int at = place[std::size_t(row)]++;
    form.innerIndexPtr()[at] = column;
    form.valuePtr()[at] = value;
  };
  for_entries(upper, [&](int row, int column, double value) {
    put(row, column, factor * value);
    if (column != row) put(column, row, factor * value);
  });
  return form;
}

}  // namespace

SparseRows harmonic_form(const SparseRows& A, const HarmonicCoordinates& c)
{
  std::vector<Phase> phases;
  for (const SparseRows* T : {&c.X, &c.Y})
    if (T->nonZeros() > 0) phases.push_back({SparseRows(T->transpose()), product(A, *T)});
  return symmetric(upper_triangle(phases, c.n()), c.weight);
}

}  // namespace chladni::cyclic
