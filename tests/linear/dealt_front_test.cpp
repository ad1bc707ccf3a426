#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "common/petsc.hpp"
#include "linear/cholesky/supernodal/shared_fronts.hpp"
#include "linear/cholesky/supernodal/tiled_columns.hpp"
#include "linear/kernels/storage.hpp"
#include "tests/linear/random_matrix.hpp"

namespace chladni::linear {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Sizes: columns that are eliminated, rows below.
class DealtFrontTest : public ::testing::TestWithParam<std::pair<int, int>> {
 protected:
  int w = GetParam().first, m = GetParam().second, n = w + m;
  int place = petsc::rank(PETSC_COMM_WORLD), n_ranks = petsc::size(PETSC_COMM_WORLD);
  DealtRows rows{w, m, {.first = 0, .last = n_ranks}, 1};
  MatrixXd triangle = MatrixXd::Zero(w, w);
  VectorXd D = VectorXd::Zero(w);

  std::vector<int> own_rows(int first, int last) const
  {
    std::vector<int> own;
    rows.for_rows(place, first, last, [&](int row) { own.push_back(row); });
    return own;
  }
  MatrixXd definite_matrix() const
  {
    const MatrixXd R = random_matrix(n, n);
    return R * R.transpose() + n * MatrixXd::Identity(n, n);
  }
  /// Eliminates the first columns; L and rest are what this rank has of them.
  int eliminate(MatrixXd& L, MatrixXd& rest)
  {
    std::vector<double> workspace(size_of_workspace(rows, place));
    return eliminate_dealt(front(L, rest, workspace));
  }
  DealtFront front(MatrixXd& L, MatrixXd& rest, std::vector<double>& workspace)
  {
    return {.rows = rows,
            .place = place,
            .comm = PETSC_COMM_WORLD,
            .L = L.data(),
            .rest = rest.data(),
            .triangle = triangle.data(),
            .D = D.data(),
            .workspace = workspace.data()};
  }
};

INSTANTIATE_TEST_SUITE_P(Sizes, DealtFrontTest,
                         ::testing::Values(std::pair{1, 0}, std::pair{1, 1}, std::pair{5, 3},
                                           std::pair{6, 6}, std::pair{7, 13}, std::pair{96, 100},
                                           std::pair{97, 1}, std::pair{230, 0},
                                           std::pair{200, 310}));

TEST_P(DealtFrontTest, IsEliminatedAsTheDenseMatrixIs)
{
  const MatrixXd A = definite_matrix();
  const std::vector<int> own = own_rows(0, n), own_below = own_rows(w, n);
  MatrixXd L = A(own, Eigen::seqN(0, w));
  MatrixXd rest = A(own_below, Eigen::seqN(w, m));
  ASSERT_EQ(eliminate(L, rest), 0);
  const MatrixXd unit = triangle.triangularView<Eigen::UnitLower>();
  const double round_off = 1e-14 * A.norm();
  EXPECT_LT((unit * D.asDiagonal() * unit.transpose() - A.topLeftCorner(w, w)).norm(), round_off);
  const MatrixXd L_below =
      A.bottomLeftCorner(m, w) * unit.transpose().inverse() * D.cwiseInverse().asDiagonal();
  const MatrixXd left = A.bottomRightCorner(m, m) - L_below * D.asDiagonal() * L_below.transpose();
  const Eigen::Index n_pivots = std::ssize(own) - std::ssize(own_below);
  for (std::size_t i = 0; i < own_below.size(); ++i) {
    const int row = own_below[i] - w;
    EXPECT_LT((L.row(n_pivots + Eigen::Index(i)) - L_below.row(row)).norm(), 1e-13);
    EXPECT_LT((rest.row(Eigen::Index(i)).head(row + 1) - left.row(row).head(row + 1)).norm(),
              round_off);
  }
  for (Eigen::Index i = 0; i < n_pivots; ++i) {
    const int row = own[std::size_t(i)];
    EXPECT_LT((L.row(i).head(row) - unit.row(row).head(row)).norm(), 1e-14 * n);
  }
}

TEST_P(DealtFrontTest, CountsNegativePivotsAndStopsAtNone)
{
  for (const auto& [last, expected] : {std::pair{-10.0, 1}, {0.0, -1}, {std::nan(""), -1}}) {
    MatrixXd A = MatrixXd::Identity(n, n);
    A(w - 1, w - 1) = last;
    MatrixXd L = A(own_rows(0, n), Eigen::seqN(0, w));
    MatrixXd rest = A(own_rows(w, n), Eigen::seqN(w, m));
    EXPECT_EQ(eliminate(L, rest), expected);
  }
}

/// A front without rows below that is the whole matrix: X <- A^-1 X on all ranks.
void solve_whole(const SharedColumns& L, Panels X)
{
  const auto n = int(X.stride) * X.n_panels;
  solve_forward(L, X);
  solve_backward(L, X);
  MPI_Allreduce(MPI_IN_PLACE, X.values, n, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
}

/// Stiff and nearly free: a chain of springs between each two of its points, held softly.
TEST(DealtFrontOfAStiffBody, HasBackwardErrorsOfRoundOff)
{
  const int w = 250;
  const DealtRows rows{w, 0, {.first = 0, .last = petsc::size(PETSC_COMM_WORLD)}, 0};
  const int place = petsc::rank(PETSC_COMM_WORLD), n_own = rows.count(place, 0, w);
  for (const double support : {1.0, 1e-6, 1e-12}) {
    MatrixXd A = MatrixXd::Zero(w, w);
    for (int i = 0; i < w; ++i) {
      for (int j = 0; j < i; ++j) {
        const double k = 1.0 / (1.0 + std::abs(i - j));
        A(i, i) += k;
        A(j, j) += k;
        A(i, j) = A(j, i) = -k;
      }
    }
    A(0, 0) += support;
    MatrixXd L(n_own, w), rest(0, 0);
    int k = 0;
    rows.for_rows(place, 0, w, [&](int row) { L.row(k++) = A.row(row); });
    MatrixXd triangle(w, w);
    VectorXd D(w);
    std::vector<double> workspace(size_of_workspace(rows, place));
    const DealtFront front{.rows = rows,
                           .place = place,
                           .comm = PETSC_COMM_WORLD,
                           .L = L.data(),
                           .rest = rest.data(),
                           .triangle = triangle.data(),
                           .D = D.data(),
                           .workspace = workspace.data()};
    ASSERT_EQ(eliminate_dealt(front), 0);
    divide_by_triangle(front);
    const AlignedNumbers tiles = aligned_numbers(shared_size(rows, place));
    store_shared(rows, place, L.data(), D.data(), tiles.get());
    const AlignedNumbers values = aligned_numbers(std::size_t(w) * panel_width);
    const MatrixXd B = random_matrix(panel_width, w);  // by rows of the panel
    std::copy_n(B.data(), B.size(), values.get());
    solve_whole({.values = tiles.get(), .rows = rows, .place = place, .first = 0, .below = {}},
                {.values = values.get(), .stride = std::size_t(w) * panel_width, .n_panels = 1});
    const MatrixXd X = Eigen::Map<const MatrixXd>(values.get(), panel_width, w);
    for (int c = 0; c < panel_width; ++c) {
      const double residual = (A * X.row(c).transpose() - B.row(c).transpose()).norm();
      EXPECT_LT(residual, 1e-15 * w * A.norm() * X.row(c).norm()) << support;
    }
  }
}

TEST_P(DealtFrontTest, SolvesWithItsRows)
{
  const MatrixXd A = definite_matrix();
  MatrixXd L = A(own_rows(0, n), Eigen::seqN(0, w));
  MatrixXd rest = A(own_rows(w, n), Eigen::seqN(w, m));
  std::vector<double> workspace(size_of_workspace(rows, place));
  const DealtFront dealt = front(L, rest, workspace);
  ASSERT_EQ(eliminate_dealt(dealt), 0);
  divide_by_triangle(dealt);
  const AlignedNumbers tiles = aligned_numbers(shared_size(rows, place));
  store_shared(rows, place, L.data(), D.data(), tiles.get());
  std::vector<int> below;
  for (int i = 0; i < m; ++i) below.push_back(3 + w + 2 * (m - 1 - i));
  const SharedColumns shared{
      .values = tiles.get(), .rows = rows, .place = place, .first = 3, .below = below};
  const int n_rows = 3 + w + 2 * m, n_panels = 3;
  const AlignedNumbers values = aligned_numbers(std::size_t(n_rows) * panel_width * n_panels);
  const Panels panels{values.get(), std::size_t(n_rows) * panel_width, n_panels};
  const auto entry = [&](int row, int column) -> double& {
    return values
        .get()[(column / panel_width) * panels.stride + row * panel_width + column % panel_width];
  };
  const MatrixXd B = random_matrix(n_rows, n_panels * panel_width);
  for (int j = 0; j < B.cols(); ++j)
    for (int i = 0; i < n_rows; ++i) entry(i, j) = i < 3 + w ? B(i, j) : 0.0;
  solve_forward(shared, panels);
  MatrixXd forward(n_rows, B.cols());
  for (int j = 0; j < B.cols(); ++j)
    for (int i = 0; i < n_rows; ++i) forward(i, j) = entry(i, j);
  MPI_Allreduce(MPI_IN_PLACE, forward.data(), int(forward.size()), MPI_DOUBLE, MPI_SUM,
                PETSC_COMM_WORLD);
  const MatrixXd unit = triangle.triangularView<Eigen::UnitLower>();
  const MatrixXd L_below =
      A.bottomLeftCorner(m, w) * unit.transpose().inverse() * D.cwiseInverse().asDiagonal();
  const MatrixXd x = unit.inverse() * B.middleRows(3, w);
  EXPECT_LT((forward.middleRows(3, w) - x).norm(), 1e-13 * x.norm());
  MatrixXd pushed(m, B.cols());
  for (int i = 0; i < m; ++i) pushed.row(i) = forward.row(below[std::size_t(i)]);
  EXPECT_LE((pushed + L_below * x).norm(), 1e-13 * x.norm());

  MatrixXd y_below(m, B.cols());
  for (int i = 0; i < m; ++i) {
    const int slot = below[std::size_t(i)];
    y_below.row(i) = B.row(slot);
    for (int j = 0; j < B.cols(); ++j) entry(slot, j) = B(slot, j);
  }
  solve_backward(shared, panels);
  MatrixXd backward(w, B.cols());
  for (int j = 0; j < B.cols(); ++j)
    for (int i = 0; i < w; ++i) backward(i, j) = entry(3 + i, j);
  MPI_Allreduce(MPI_IN_PLACE, backward.data(), int(backward.size()), MPI_DOUBLE, MPI_SUM,
                PETSC_COMM_WORLD);
  const MatrixXd y = unit.transpose().inverse() *
                     (D.cwiseInverse().asDiagonal() * x - L_below.transpose() * y_below);
  EXPECT_LT((backward - y).norm(), 1e-13 * y.norm() + 1e-300);
}

}  // namespace
}  // namespace chladni::linear
