#include "linear/lanczos/parted_lanczos.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/petsc.hpp"
#include "linear/kernels/storage.hpp"

namespace chladni::linear {

namespace {

PetscInt n_rows_of(Mat M)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(M, &n, nullptr));
  return n;
}

/// Pairs up to lambda by the power law through all that a part has and the first half of them.
double expected_below(double lambda, const BlockLanczos& found)
{
  const PetscInt n = found.n_pairs();
  if (n < 2) return n * lambda / found.lambda(n - 1);
  const PetscInt half = n / 2;
  const double ratio = found.lambda(n - 1) / found.lambda(half - 1);
  constexpr double of_a_beam = 0.25, of_a_solid = 1.5;  // frequencies grow with n^2 to n^(1/3)
  const double power = std::log(double(n) / half) / std::log(std::max(ratio, 1.0 + 1e-6));
  return n * std::pow(lambda / found.lambda(n - 1), std::clamp(power, of_a_beam, of_a_solid));
}

}  // namespace

PartedLanczos::PartedLanczos(BlockSolve solve, PetscInt most, Mat M,
                             const BlockLanczosOptions& options)
    : M_(M), scratch_(options.scratch)
{
  parts_.resize(1);
  parts_.front().n_rows = n_rows_of(M);
  parts_.front().most = std::min(most, parts_.front().n_rows);
  parts_.front().lanczos = std::make_unique<BlockLanczos>(std::move(solve), M, options);
}

PartedLanczos::PartedLanczos(Mat factor, Mat M, const BlockLanczosOptions& options)
    : PartedLanczos([factor](Mat B, Mat X) { petsc::check(MatMatSolve(factor, B, X)); },
                    n_rows_of(M), M, options)
{}

PartedLanczos::PartedLanczos(std::vector<DecoupledPart> parts, Mat M,
                             const BlockLanczosOptions& options)
    : M_(M), scratch_(options.scratch)
{
  for (DecoupledPart& given : parts) {
    Part part;
    PetscReal largest = 0.0;
    petsc::check(MatCreateSubMatrix(M, given.rows, given.rows, MAT_INITIAL_MATRIX, part.M.put()));
    petsc::check(MatNorm(part.M, NORM_INFINITY, &largest));
    if (largest == 0.0 || given.most == 0) continue;
    part.rows = petsc::own_rows(given.rows, M);
    part.n_rows = n_rows_of(part.M);
    part.most = std::min(given.most, part.n_rows);
    part.lanczos = std::make_unique<BlockLanczos>(std::move(given.solve), part.M, options);
    parts_.push_back(std::move(part));
  }
}

void PartedLanczos::converge(Part& part, PetscInt n_pairs)
{
  part.n_asked = std::min(n_pairs, part.most);
  part.lanczos->converge(part.n_asked);
}

/// A quarter of what the part would have if all had them as densely.
PetscInt PartedLanczos::first_guess(const Part& part, PetscInt n_pairs) const
{
  if (parts_.size() == 1) return n_pairs;
  const double share = double(part.n_rows) / n_rows_of(M_);
  return std::max<PetscInt>(2, static_cast<PetscInt>(share * n_pairs / 4.0));
}

void PartedLanczos::converge(PetscInt n_pairs)
{
  for (Part& part : parts_) {
    const PetscInt n = std::max(part.n_asked, first_guess(part, n_pairs));
    if (part.n_asked < n || parts_.size() == 1) converge(part, n);
  }
  while (n_complete() < n_pairs) converge_further(n_pairs);
  merge(n_pairs);
}

void PartedLanczos::converge_beyond(double lambda)
{
  for (Part& part : parts_) {
    if (part.n_asked > 0 && (part.has_all() || part.last() > lambda)) continue;
    part.lanczos->converge_beyond(lambda, part.most);
    const PetscInt n = part.lanczos->n_pairs();
    const bool goes_on = n > 0 && part.last() > lambda;
    part.n_asked = goes_on ? n : n + 1;
  }
  merge(n_complete());
}

bool PartedLanczos::has_all() const
{
  PetscInt n = 0;
  for (const Part& part : parts_) n += part.lanczos->n_pairs();
  return n == n_pairs() && std::ranges::all_of(parts_, &Part::has_all);
}

/// Pairs up to the last of the part that has come least far: none is missing among them.
PetscInt PartedLanczos::n_complete() const
{
  double end = all_of_them;
  for (const Part& part : parts_)
    if (!part.has_all()) end = std::min(end, part.last());
  if (end == all_of_them) return std::numeric_limits<PetscInt>::max();
  PetscInt n = 0;
  for (const Part& part : parts_)
    for (PetscInt i = 0; i < part.lanczos->n_pairs(); ++i) n += part.lanczos->lambda(i) <= end;
  return n;
}

/// The lambda up to which there are n pairs, as the parts have them so far.
double PartedLanczos::expected_end(PetscInt n_pairs) const
{
  double low = 0.0, high = 0.0;
  for (const Part& part : parts_)
    if (part.lanczos->n_pairs() > 0) high = std::max(high, part.last());
  const auto expected = [&](double lambda) {
    double n = 0.0;
    for (const Part& part : parts_) {
      const PetscInt found = part.lanczos->n_pairs();
      if (found > 0) {
        n += part.has_all() ? std::min<double>(found, expected_below(lambda, *part.lanczos))
                            : expected_below(lambda, *part.lanczos);
      }
    }
    return n;
  };
  constexpr int halvings = 40;
  for (int i = 0; i < halvings && expected(high) < n_pairs; ++i) high *= 2.0;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (expected(middle) < n_pairs ? low : high) = middle;
  }
  return high;
}

/// The parts that lack pairs below where the range is expected to end; at least the one that has
/// come least far.
void PartedLanczos::converge_further(PetscInt n_pairs)
{
  const double end = expected_end(n_pairs);
  const auto last = [](const Part& part) { return part.has_all() ? all_of_them : part.last(); };
  const auto least =
      std::ranges::min_element(parts_, {}, [&](const Part& part) { return last(part); });
  const double least_end = last(*least);
  for (Part& part : parts_) {
    if (last(part) > std::max(end, least_end)) continue;
    const double expected = std::min(double(n_pairs), expected_below(end, *part.lanczos));
    const PetscInt n_found = part.lanczos->n_pairs();
    converge(part, std::max(static_cast<PetscInt>(std::ceil(expected)), n_found) + 1);
  }
}

/// All pairs in order, as far as none is missing.
void PartedLanczos::merge(PetscInt n_pairs)
{
  pairs_.clear();
  for (std::size_t k = 0; k < parts_.size(); ++k)
    for (PetscInt i = 0; i < parts_[k].lanczos->n_pairs(); ++i)
      pairs_.push_back({.lambda = parts_[k].lanczos->lambda(i), .part = k, .place = i});
  std::ranges::stable_sort(pairs_, {}, &Pair::lambda);
  pairs_.resize(std::min<std::size_t>(pairs_.size(), n_pairs));
}

void PartedLanczos::require_resolved(double lambda) const
{
  for (const Part& part : parts_) part.lanczos->require_resolved(lambda);
}

double PartedLanczos::unresolved_from() const
{
  double from = all_of_them;
  for (const Part& part : parts_) from = std::min(from, part.lanczos->unresolved_from());
  return from;
}

PetscInt PartedLanczos::n_solves() const
{
  PetscInt n = 0;
  for (const Part& part : parts_) n += part.lanczos->n_solves();
  return n;
}

double PartedLanczos::numbers_solved() const
{
  double n = 0.0;
  for (const Part& part : parts_) n += double(part.lanczos->n_solves()) * part.n_rows;
  return n;
}

petsc::Matrix PartedLanczos::vectors(PetscInt first, PetscInt last) const
{
  if (parts_.size() == 1 && parts_.front().M == nullptr)
    return parts_.front().lanczos->vectors(first, last);
  petsc::Matrix X = large_dense(M_, last - first, scratch_);
  PetscInt ld = 0;
  petsc::check(MatDenseGetLDA(X, &ld));
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    std::vector<PetscInt> columns, places;
    for (PetscInt i = first; i < last; ++i) {
      if (pairs_[i].part != k) continue;
      columns.push_back(i - first);
      places.push_back(pairs_[i].place);
    }
    if (places.empty()) continue;
    const petsc::Matrix part = parts_[k].lanczos->vectors(places.front(), places.back() + 1);
    const LocalRows values(part);
    PetscScalar* x = nullptr;
    petsc::check(MatDenseGetArray(X, &x));
    for (std::size_t j = 0; j < columns.size(); ++j)
      for (PetscInt i = 0; i < values.n_rows(); ++i)
        x[parts_[k].rows[i] + std::size_t(columns[j]) * ld] = values(i, static_cast<PetscInt>(j));
    petsc::check(MatDenseRestoreArray(X, &x));
  }
  return X;
}

}  // namespace chladni::linear
