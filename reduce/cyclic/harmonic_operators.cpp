#include "reduce/cyclic/harmonic_coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/eigen_every.hpp"
#include "common/petsc.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "reduce/cyclic/sector.hpp"

namespace chladni::cyclic {

using Eigen::MatrixXd;

namespace {

double phase_angle(int order, int count)
{
  return 2.0 * std::numbers::pi * order / count;
}

/// How many of ascending rows are less than this one.
PetscInt n_before(const std::vector<PetscInt>& rows, PetscInt row)
{
  return static_cast<PetscInt>(std::ranges::lower_bound(rows, row) - rows.begin());
}

void refuse_double_rows(std::vector<PetscInt> rows, const char* name)
{
  std::ranges::sort(rows);
  const auto twin = std::ranges::adjacent_find(rows);
  if (twin != rows.end()) throw Error(fmt::format("row {} is twice in the {} edge", *twin, name));
}

/// A row that is in both sets stands for itself, or the sector is nothing but edges.
void refuse_overlap(const MatchingRows& rows)
{
  std::vector<PetscInt> high = rows.high;
  std::ranges::sort(high);
  const auto b = static_cast<std::size_t>(rows.R.rows());
  for (std::size_t i = 0; i < rows.low.size(); ++i) {
    if (!std::ranges::binary_search(high, rows.low[i])) continue;
    const std::size_t first = i / b * b;
    if (!std::equal(rows.low.begin() + first, rows.low.begin() + first + b,
                    rows.high.begin() + first)) {
      throw Error(fmt::format(
          "row {} is in both edges; only a node that all sectors share may be, at the same place "
          "in both and with all its components",
          rows.low[i]));
    }
  }
}

void refuse_wrong_turn(const MatchingRows& rows)
{
  constexpr double round_off = 1e-8;
  const auto far_from_identity = [](const MatrixXd& A) {
    return (A - MatrixXd::Identity(A.rows(), A.cols())).cwiseAbs().maxCoeff();
  };
  if (const double error = far_from_identity(rows.R.transpose() * rows.R); !(error < round_off)) {
    throw Error(fmt::format(
        "the rotation is not orthogonal (R^T R differs from the identity by {:.1e})", error));
  }
  MatrixXd power = MatrixXd::Identity(rows.R.rows(), rows.R.cols());
  for (int j = 0; j < rows.count; ++j) power = (power * rows.R).eval();
  if (const double error = far_from_identity(power); !(error < round_off)) {
    throw Error(fmt::format(
        "{} times the rotation is no whole turn (R^{} differs from the identity by {:.1e}); give "
        "that by one sector",
        rows.count, rows.count, error));
  }
}

}  // namespace

void check_matching_rows(const MatchingRows& rows, PetscInt n_rows)
{
  if (rows.count < 2) throw Error(fmt::format("{} sectors; give at least 2", rows.count));
  if (rows.low.size() != rows.high.size()) {
    throw Error(
        fmt::format("the low edge has {} rows and the high edge {}; each row of the one is matched "
                    "by a row of the other",
                    rows.low.size(), rows.high.size()));
  }
  if (rows.low.empty()) throw Error("the edges have no rows; give those of both cut edges");
  if (std::ssize(rows.low) % rows.R.rows() != 0) {
    throw Error(
        fmt::format("the edges have {} rows, which the block size {} of the rotation does not "
                    "divide",
                    rows.low.size(), rows.R.rows()));
  }
  for (const auto* side : {&rows.low, &rows.high}) {
    const auto outside =
        std::ranges::find_if(*side, [&](PetscInt row) { return row < 0 || row >= n_rows; });
    if (outside == side->end()) continue;
    throw Error(fmt::format("row {} of the {} edge is out of range; rows are 0 to {}", *outside,
                            side == &rows.low ? "low" : "high", n_rows - 1));
  }
  refuse_double_rows(rows.low, "low");
  refuse_double_rows(rows.high, "high");
  refuse_overlap(rows);
  refuse_wrong_turn(rows);
}

namespace {

/// The motions x of a shared node that a turn multiplies by exp(-i mu), (R + R^T) x = 2 cos(mu) x.
MatrixXd shared_motions(const MatrixXd& R, double mu)
{
  constexpr double same = 1e-7;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(MatrixXd(0.5 * (R + R.transpose())));
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = 0; k < R.rows(); ++k)
    if (std::abs(eigen.eigenvalues()[k] - std::cos(mu)) < same) columns.push_back(k);
  return eigen.eigenvectors()(every, columns);
}

}  // namespace

SectorCoordinates::SectorCoordinates(MatchingRows rows, int order)
    : rows_(std::move(rows)), order_(order)
{
  const MatrixXd motions = shared_motions(rows_.R, phase_angle(order, rows_.count));
  if (motions.cols() > 0) {
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(motions.transpose());
    for (Eigen::Index k = 0; k < motions.cols(); ++k)
      kept_.push_back(static_cast<int>(qr.colsPermutation().indices()[k]));
    std::ranges::sort(kept_);
    E_ = motions * MatrixXd(motions(kept_, every)).inverse();
  }
  const auto b = static_cast<std::size_t>(rows_.R.rows());
  for (std::size_t i = 0; i < rows_.high.size(); ++i) {
    const bool is_shared = rows_.low[i] == rows_.high[i];
    const bool is_kept = std::ranges::find(kept_, static_cast<int>(i % b)) != kept_.end();
    (is_shared && is_kept ? single_ : without_).push_back(rows_.high[i]);
  }
  std::ranges::sort(without_);
  std::ranges::sort(single_);
}

bool SectorCoordinates::has_one_phase() const
{
  return cyclic::has_one_phase(order_, rows_.count);
}

PetscInt SectorCoordinates::first(PetscInt row) const
{
  const PetscInt n = row - n_before(without_, row);
  return has_one_phase() ? n : 2 * n - n_before(single_, row);
}

PetscInt SectorCoordinates::row_of(PetscInt coordinate) const
{
  // first(low) <= coordinate < first(high)
  PetscInt low = 0, high = coordinate + static_cast<PetscInt>(without_.size()) + 1;
  while (high - low > 1) {
    const PetscInt middle = low + (high - low) / 2;
    (first(middle) <= coordinate ? low : high) = middle;
  }
  return low;
}

std::string SectorCoordinates::name_of(PetscInt coordinate) const
{
  const PetscInt row = row_of(coordinate);
  const char* const phase = n_of(row) < 2 ? "" : coordinate == first(row) ? ", in x" : ", in y";
  return fmt::format("row {} of K{}", row, phase);
}

PetscInt SectorCoordinates::followed_by(PetscInt row) const
{
  const auto it = std::ranges::find(rows_.high, row);
  if (it == rows_.high.end()) return -1;
  const PetscInt low = rows_.low[static_cast<std::size_t>(it - rows_.high.begin())];
  return low == row ? -1 : low;
}

std::vector<PetscInt> SectorCoordinates::alike(PetscInt row) const
{
  const auto it = std::ranges::find(rows_.high, row);
  if (it == rows_.high.end() || followed_by(row) >= 0 || E_.size() == 0) return {};
  constexpr double round_off = 1e-10;
  const Eigen::Index b = E_.rows(), place = (it - rows_.high.begin()) % b;
  // Components of the graph whose edges are what a row without a coordinate takes from others.
  std::vector<Eigen::Index> group(static_cast<std::size_t>(b));
  std::iota(group.begin(), group.end(), Eigen::Index{0});
  for (Eigen::Index i = 0; i < b; ++i) {
    if (std::ranges::find(kept_, static_cast<int>(i)) != kept_.end()) continue;
    for (std::size_t j = 0; j < kept_.size(); ++j) {
      if (std::abs(E_(i, static_cast<Eigen::Index>(j))) > round_off) {
        std::ranges::replace(group, Eigen::Index{group[std::size_t(i)]},
                             Eigen::Index{group[std::size_t(kept_[j])]});
      }
    }
  }
  std::vector<PetscInt> rows;
  for (Eigen::Index i = 0; i < b; ++i)
    if (group[std::size_t(i)] == group[std::size_t(place)]) rows.push_back(*(it - place + i));
  return rows.size() > 1 ? rows : std::vector<PetscInt>{};
}

/// What of a block its phase takes from its own x and y, from those of the block that it follows,
/// and from the kept components of a shared one.
struct SectorCoordinates::Phase {
  PetscInt own;         ///< 0 of x, 1 of y
  MatrixXd of_x, of_y;  ///< [b x b]
  MatrixXd of_kept;     ///< [b x n_kept]
};

petsc::Matrix SectorCoordinates::X(Mat like) const
{
  const double mu = phase_angle(order_, rows_.count);
  const MatrixXd& R = rows_.R;
  return phase(like, {.own = 0,
                      .of_x = std::cos(mu) * R,
                      .of_y = has_one_phase() ? MatrixXd() : MatrixXd(-std::sin(mu) * R),
                      .of_kept = E_});
}

petsc::Matrix SectorCoordinates::Y(Mat like) const
{
  // Of a shared node x + i y = exp(i mu) R (x + i y).
  const double mu = phase_angle(order_, rows_.count);
  const MatrixXd& R = rows_.R;
  return phase(like, {.own = 1,
                      .of_x = std::sin(mu) * R,
                      .of_y = std::cos(mu) * R,
                      .of_kept = E_.size() > 0 ? MatrixXd((std::cos(mu) * E_ - R.transpose() * E_) /
                                                          std::sin(mu))
                                               : MatrixXd()});
}

petsc::Matrix SectorCoordinates::phase(Mat like, const Phase& phase) const
{
  PetscInt n = 0, begin = 0, end = 0;
  petsc::check(MatGetSize(like, &n, nullptr));
  petsc::check(MatGetOwnershipRange(like, &begin, &end));
  const auto most = static_cast<PetscInt>(2 * rows_.R.rows());
  petsc::Matrix T;
  petsc::check(MatCreateAIJ(petsc::communicator(like), end - begin, first(end) - first(begin), n,
                            first(n), most, nullptr, most, nullptr, T.put()));
  const auto put = [&](PetscInt row, PetscInt coordinate, double value) {
    if (value != 0.0) petsc::check(MatSetValue(T, row, coordinate, value, INSERT_VALUES));
  };
  std::vector<PetscInt> in_high = rows_.high;
  std::ranges::sort(in_high);
  for (PetscInt row = begin; row < end; ++row)
    if (!std::ranges::binary_search(in_high, row)) put(row, first(row) + phase.own, 1.0);
  const Eigen::Index b = rows_.R.rows();
  for (Eigen::Index k = 0; k < std::ssize(rows_.high); ++k) {
    const PetscInt row = rows_.high[static_cast<std::size_t>(k)];
    if (row < begin || row >= end) continue;
    const Eigen::Index i = k % b;
    const PetscInt* const block = rows_.low.data() + (k - i);
    if (block[i] == row) {
      for (std::size_t j = 0; j < kept_.size(); ++j)
        put(row, first(block[kept_[j]]), phase.of_kept(i, static_cast<Eigen::Index>(j)));
      continue;
    }
    for (Eigen::Index j = 0; j < b; ++j) {
      put(row, first(block[j]), phase.of_x(i, j));
      if (phase.of_y.size() > 0) put(row, first(block[j]) + 1, phase.of_y(i, j));
    }
  }
  petsc::check(MatAssemblyBegin(T, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(T, MAT_FINAL_ASSEMBLY));
  return T;
}

SectorHarmonic sector_harmonic(MatchingRows rows, int order, Mat like)
{
  SectorHarmonic harmonic{.coordinates = {std::move(rows), order}, .X = {}, .Y = {}};
  harmonic.X = harmonic.coordinates.X(like);
  if (!harmonic.coordinates.has_one_phase()) harmonic.Y = harmonic.coordinates.Y(like);
  return harmonic;
}

petsc::Matrix harmonic_operator(Mat A, const SectorHarmonic& harmonic)
{
  petsc::Matrix sum;
  petsc::check(MatPtAP(A, harmonic.X, MAT_INITIAL_MATRIX, petsc::automatic, sum.put()));
  if (harmonic.Y) {
    petsc::Matrix of_y;
    petsc::check(MatPtAP(A, harmonic.Y, MAT_INITIAL_MATRIX, petsc::automatic, of_y.put()));
    petsc::check(MatAXPY(sum, 1.0, of_y, DIFFERENT_NONZERO_PATTERN));
  }
  petsc::check(MatScale(sum, harmonic.coordinates.weight()));
  return sum;
}

}  // namespace chladni::cyclic
