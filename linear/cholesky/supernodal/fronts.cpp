#include "linear/cholesky/supernodal/fronts.hpp"

#include <algorithm>

#include "linear/cholesky/supernodal/dense_elimination.hpp"

namespace chladni::linear {

Fronts::Fronts(const AssemblyTree& tree, const MatrixRows& A)
    : tree_(tree),
      A_(A),
      places_(tree),
      children_(tree.n_supernodes()),
      left_over_(tree.n_supernodes())
{
  for (int s = 0; s < tree.n_supernodes(); ++s)
    if (tree.parent[s] != -1) children_[tree.parent[s]].push_back(s);
}

double* Fronts::left_over(int s)
{
  const std::size_t m = tree_.n_below[s];
  if (!left_over_[s])
    left_over_[s] = std::make_unique_for_overwrite<double[]>(m * m);  // NOLINT(*-avoid-c-arrays)
  return left_over_[s].get();
}

void Fronts::add_entries(int s)
{
  const std::size_t front = std::size_t(tree_.n_columns(s)) + tree_.n_below[s];
  places_.for_entries(A_, [&](int row, int column, double value) {
    columns_[std::size_t(row) + std::size_t(column) * front] += value;
  });
}

void Fronts::add_left_over(int child, int s)
{
  const std::span<const int> rows = tree_.below(child);
  const std::size_t m = rows.size(), w = tree_.n_columns(s), n_below = tree_.n_below[s];
  std::vector<std::size_t> place(m);
  for (std::size_t i = 0; i < m; ++i) place[i] = places_.place(rows[i]);
  for (std::size_t j = 0; j < m; ++j) {
    const double* from = left_over_[child].get() + j * m;
    double* to = place[j] < w ? columns_.data() + place[j] * (w + n_below)
                              : left_over_[s].get() + (place[j] - w) * n_below - w;
    for (std::size_t i = j; i < m; ++i) to[place[i]] += from[i];
  }
  left_over_[child].reset();
}

int Fronts::eliminate(int s)
{
  const std::span<const int> below = tree_.below(s);
  places_.enter(s);
  const int w = tree_.n_columns(s), m = static_cast<int>(below.size());
  const std::size_t n_numbers = std::size_t(w + m) * w;
  columns_.assign(n_numbers, 0.0);
  if (scaled_columns_.size() < n_numbers) scaled_columns_.resize(n_numbers);
  add_entries(s);
  if (m > 0) left_over(s);
  double kept = 0.0;
  for (const int child : children_[s]) {
    if (!left_over_[child]) continue;
    if (kept == 0.0) std::fill_n(left_over_[s].get(), std::size_t(m) * m, 0.0);
    kept = 1.0;
    add_left_over(child, s);
  }
  const FrontColumns front{
      .A = columns_.data(), .W = scaled_columns_.data(), .n_rows = w + m, .n_columns = w};
  const int n_negative = eliminate_columns(front);
  if (n_negative >= 0 && m > 0) subtract_from_rest(front, kept, left_over_[s].get());
  return n_negative;
}

double peak_of_left_overs(const AssemblyTree& tree, const std::vector<int>& supernodes)
{
  std::vector<double> waiting(tree.n_supernodes(), 0.0);  // of the children of each
  double now = 0.0, peak = 0.0;
  for (const int s : supernodes) {
    const double m = tree.n_below[s];
    now += m * m;
    peak = std::max(peak, now);
    now -= waiting[s];
    if (tree.parent[s] != -1) waiting[tree.parent[s]] += m * m;
  }
  return peak;
}

}  // namespace chladni::linear
