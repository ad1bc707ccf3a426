#include "reduce/cyclic/harmonic_coordinates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "common/eigen_every.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "reduce/cyclic/harmonic_model.hpp"

namespace chladni::cyclic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr int mirror_count = 6;
constexpr double step = 2.0 * std::numbers::pi / mirror_count, first = 0.2;

/// A sector of eight nodes: two of a ring at the cut edges and one between, two at the cut edges,
/// two inside that are each other's image, and one on the axis.
struct MirroredSector {
  SectorDofs dofs{.count = mirror_count,
                  .n_blocks = 8,
                  .components = {0, 1, 2, 3, 4, 5},
                  .edges = {{{0, 1}}, {{3, 4}}},
                  .axis = {7},
                  .rings = {}};
  Eigen::MatrixX3d positions = Eigen::MatrixX3d::Zero(8, 3);
  MatrixXd K;

  explicit MirroredSector(unsigned seed)
  {
    std::srand(seed);
    place(0, 1.0, first, 0.0);
    place(1, 1.0, first + step, 0.0);
    place(2, 1.0, first + 0.5 * step, 0.0);
    place(3, 2.0, first, 0.3);
    place(4, 2.0, first + step, 0.3);
    place(5, 1.5, first + 0.3 * step, 0.1);
    place(6, 1.5, first + 0.7 * step, 0.1);
    dofs.rings.push_back({.blocks = {0, 1, 2},
                          .angles = {first, first + step, first + 0.5 * step},
                          .n_nodes = 2 * mirror_count,
                          .first_angle = first,
                          .up_to = mirror_count});
    const MatrixXd A = MatrixXd::Random(48, 48), S = mirror();
    const MatrixXd any = A * A.transpose() + MatrixXd::Identity(48, 48);
    K = 0.5 * (any + S * any * S.transpose());
  }

  void place(int block, double r, double angle, double z)
  {
    positions.row(block) << r * std::cos(angle), r * std::sin(angle), z;
  }

  static MatrixXd mirror()
  {
    const double angle = first + 0.5 * step;
    const Eigen::Vector3d normal(-std::sin(angle), std::cos(angle), 0.0);
    const Eigen::Matrix3d Q = Eigen::Matrix3d::Identity() - 2.0 * normal * normal.transpose();
    MatrixXd S = MatrixXd::Zero(48, 48);
    const int image[] = {1, 0, 2, 4, 3, 6, 5, 7};
    for (int block = 0; block < 8; ++block) {
      S.block<3, 3>(6 * block, 6 * image[block]) = Q;
      S.block<3, 3>(6 * block + 3, 6 * image[block] + 3) = -Q;
    }
    return S;
  }

  SparseRows form() const
  {
    SparseRows rows = K.sparseView(0.0, 0.0);
    rows.makeCompressed();
    return rows;
  }
};

VectorXd eigenvalues(const MatrixXd& A)
{
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

TEST(Mirror, IsFoundWherePositionsAndMatricesHaveIt)
{
  const MirroredSector sector(3);
  const SparseRows K = sector.form();
  const auto mirror = find_mirror(sector.dofs, sector.positions, {&K});
  ASSERT_TRUE(mirror);
  EXPECT_NEAR(mirror->angle, first + 0.5 * step, 1e-14);
  EXPECT_EQ(mirror->image, (std::vector<int>{1, 0, 2, 4, 3, 6, 5, 7}));
}

TEST(Mirror, IsNotSeenWhereOneEntryOrOnePositionDiffers)
{
  const MirroredSector sector(3);
  MirroredSector stiffer = sector, moved = sector, curved = sector;
  stiffer.K(30, 30) *= 1.0 + 1e-7;
  const SparseRows K = sector.form(), other = stiffer.form();
  EXPECT_FALSE(find_mirror(sector.dofs, sector.positions, {&K, &other}));
  moved.positions(5, 2) += 1e-4;
  EXPECT_FALSE(find_mirror(moved.dofs, moved.positions, {&K}));
  curved.place(3, 2.0, first + 0.05, 0.3);  // a cut that is not straight
  curved.place(4, 2.0, first + 0.05 + step, 0.3);
  EXPECT_FALSE(find_mirror(curved.dofs, curved.positions, {&K}));
}

TEST(Mirror, IsNotSeenWhereItTakesARingToOtherNodes)
{
  const MirroredSector sector(3);
  const SparseRows K = sector.form();
  const auto with_ring = [&](std::vector<int> blocks) {
    SectorDofs dofs = sector.dofs;
    std::vector<double> angles;
    for (const int block : blocks)
      angles.push_back(std::atan2(sector.positions(block, 1), sector.positions(block, 0)));
    dofs.rings.push_back({.blocks = std::move(blocks),
                          .angles = angles,
                          .n_nodes = mirror_count,
                          .first_angle = angles.front(),
                          .up_to = 1});
    return find_mirror(dofs, sector.positions, {&K}).has_value();
  };
  // Nodes 5 and 6 are each other's image, 3 and 4 at the cut edges too.
  EXPECT_FALSE(with_ring({5}));
  EXPECT_FALSE(with_ring({6}));
  EXPECT_TRUE(with_ring({3, 4}));
}

TEST(SymmetricMotions, HaveEachEigenvalueOnceOfThoseThatAreDouble)
{
  MirroredSector sector(4);
  const SparseRows K_1 = sector.form();
  sector.dofs.mirror = find_mirror(sector.dofs, sector.positions, {&K_1});
  for (const int n : {1, 2}) {
    const HarmonicCoordinates c = harmonic_coordinates(sector.dofs, n);
    const MatrixXd B(c.symmetric), K(harmonic_form(K_1, c));
    ASSERT_EQ(2 * B.cols(), c.n()) << n;
    EXPECT_LT((B.transpose() * B - MatrixXd::Identity(B.cols(), B.cols())).norm(), 1e-14) << n;
    SparseRows unit(c.n(), c.n());
    unit.setIdentity();
    const MatrixXd J(times_quarter_turn(unit, c));
    EXPECT_LT((B.transpose() * K * J * B).norm(), 1e-13 * K.norm()) << n;
    const VectorXd once = eigenvalues(B.transpose() * K * B), all = eigenvalues(K);
    for (Index k = 0; k < once.size(); ++k) {
      EXPECT_NEAR(once[k], all[2 * k], 1e-12 * all[2 * k]) << n;
      EXPECT_NEAR(once[k], all[2 * k + 1], 1e-12 * all[2 * k]) << n;
    }
  }
}

/// The lowest frequency of a harmonic without some coordinates.
double lowest_omega(const SectorMatrices& sector, const HarmonicCoordinates& c,
                    const std::vector<int>& held)
{
  std::vector<int> free;
  for (int i = 0; i < c.n(); ++i)
    if (!std::ranges::count(held, i)) free.push_back(i);
  const MatrixXd K = MatrixXd(harmonic_form(sector.K, c))(free, free);
  const MatrixXd M = MatrixXd(harmonic_form(sector.M, c))(free, free);
  return std::sqrt(Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M, Eigen::EigenvaluesOnly)
                       .eigenvalues()[0]);
}

TEST(HarmonicModes, LieAboveAFrequencyWhereTheLowestDoes)
{
  const MirroredSector stiff(7), heavy(8);
  const SectorMatrices matrices{.K = stiff.form(), .M = heavy.form()};
  std::vector<bool> none(48, false), axis(48, false);
  std::fill(axis.begin() + 42, axis.end(), true);
  SectorDofs mirrored = stiff.dofs;
  mirrored.mirror = find_mirror(stiff.dofs, stiff.positions, {&matrices.K, &matrices.M});
  ASSERT_TRUE(mirrored.mirror);
  for (const SectorDofs* dofs : {&stiff.dofs, &std::as_const(mirrored)}) {
    for (const int order : {0, 1, 2, 3}) {
      const HarmonicCoordinates c = harmonic_coordinates(*dofs, order);
      std::vector<int> of_axis;
      for (const Master& master : c.masters)
        if (master.ring == -1) of_axis.push_back(master.coordinate);
      const double free = lowest_omega(matrices, c, {}), held = lowest_omega(matrices, c, of_axis);
      EXPECT_TRUE(all_modes_lie_above(matrices, c, none, free * (1.0 - 1e-5))) << order;
      EXPECT_FALSE(all_modes_lie_above(matrices, c, none, free)) << order;
      EXPECT_TRUE(all_modes_lie_above(matrices, c, axis, held * (1.0 - 1e-5))) << order;
      EXPECT_FALSE(all_modes_lie_above(matrices, c, axis, held)) << order;
    }
  }
}

TEST(SymmetricHalf, UnfoldsToTheMastersOfTheWholeHarmonic)
{
  MirroredSector sector(5);
  const SparseRows K_1 = sector.form();
  sector.dofs.mirror = find_mirror(sector.dofs, sector.positions, {&K_1});
  for (const int n : {1, 2}) {
    const HarmonicCoordinates c = harmonic_coordinates(sector.dofs, n), half = symmetric_half(c);
    ASSERT_EQ(2 * half.masters.size(), c.masters.size()) << n;
    std::vector<int> whole_rows, half_rows;
    for (const Master& master : c.masters) whole_rows.push_back(master.coordinate);
    for (const Master& master : half.masters) half_rows.push_back(master.coordinate);
    const MatrixXd K = MatrixXd(harmonic_form(K_1, c))(whole_rows, whole_rows);
    const MatrixXd K_half = MatrixXd(harmonic_form(K_1, half))(half_rows, half_rows);
    EXPECT_LT((unfolded_form(K_half, master_halves(c, half)) - K).norm(), 1e-14 * K.norm()) << n;
  }
}

TEST(SymmetricHalf, MovesTheSectorAsTheWholeHarmonicDoes)
{
  MirroredSector sector(6);
  const SparseRows K_1 = sector.form();
  sector.dofs.mirror = find_mirror(sector.dofs, sector.positions, {&K_1});
  const HarmonicCoordinates c = harmonic_coordinates(sector.dofs, 2), half = symmetric_half(c);
  std::vector<int> whole_rows, half_rows;
  for (const Master& master : c.masters) whole_rows.push_back(master.coordinate);
  for (const Master& master : half.masters) half_rows.push_back(master.coordinate);
  const SectorMotion motion = unfolded_motion(
      {.x = MatrixXd(half.X)(every, half_rows), .y = MatrixXd(half.Y)(every, half_rows)},
      master_halves(c, half));
  EXPECT_LT((motion.x - MatrixXd(c.X)(every, whole_rows)).norm(), 1e-14);
  EXPECT_LT((motion.y - MatrixXd(c.Y)(every, whole_rows)).norm(), 1e-14);
}

TEST(SymmetricHalf, HasACertificateOfWhichTheWholeHasEachEigenvalueTwice)
{
  reduce::Certificate half;
  half.lambda = {1.0, 4.0};
  half.estimates = {1e-3, 2e-3};
  half.n_zero = 3;
  const reduce::Certificate whole = unfolded_certificate(half);
  EXPECT_EQ(whole.lambda, (std::vector{1.0, 1.0, 4.0, 4.0}));
  EXPECT_EQ(whole.estimates, (std::vector{1e-3, 1e-3, 2e-3, 2e-3}));
  EXPECT_EQ(whole.n_zero, 6);
}

/// A harmonic reduced to its masters and all modes besides, which is no approximation.
HarmonicModel completely_reduced(const SectorMatrices& matrices, const HarmonicCoordinates& c)
{
  const auto n_solved = c.symmetric.size() > 0 ? c.n() / 2 : c.n();
  const auto n_masters = std::ssize(c.masters) / (c.symmetric.size() > 0 ? 2 : 1);
  reduce::PhaseListener silent;
  return reduce_harmonic(
      matrices, c, {.basis = {.modes = int(n_solved - n_masters)}},
      [](const Master&) { return false; }, silent);
}

TEST(HarmonicModel, OfAllModesIsTheHarmonicWithAndWithoutItsMirror)
{
  const MirroredSector stiff(7), heavy(8);
  const SectorMatrices matrices{.K = stiff.form(), .M = heavy.form()};
  SectorDofs mirrored = stiff.dofs;
  mirrored.mirror = find_mirror(stiff.dofs, stiff.positions, {&matrices.K, &matrices.M});
  ASSERT_TRUE(mirrored.mirror);
  std::vector<int> all(48);
  std::iota(all.begin(), all.end(), 0);
  for (const SectorDofs* dofs : {&stiff.dofs, &std::as_const(mirrored)}) {
    for (const int order : {0, 1, 2, 3}) {
      const HarmonicCoordinates c = harmonic_coordinates(*dofs, order);
      const HarmonicModel model = completely_reduced(matrices, c);
      ASSERT_EQ(model.K.rows(), c.n());
      const auto spectrum = [](const MatrixXd& K, const MatrixXd& M) -> VectorXd {
        return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M, Eigen::EigenvaluesOnly)
            .eigenvalues();
      };
      const VectorXd expected =
          spectrum(MatrixXd(harmonic_form(matrices.K, c)), MatrixXd(harmonic_form(matrices.M, c)));
      const VectorXd found = spectrum(model.K, model.M);
      // Residuals of 1e-9 of the modes.
      EXPECT_LT((found - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 1e-9) << order;
      for (std::size_t k = 0; k < model.certificate.lambda.size(); ++k)
        EXPECT_NEAR(model.certificate.lambda[k] / expected[Index(k)], 1.0, 1e-9) << order;
      // What the model says of the sector's motion has the energy of the model.
      const SectorMotion motion = sector_motion(model, all);
      for (const auto& [form, of_model] :
           {std::pair{&matrices.K, &model.K}, std::pair{&matrices.M, &model.M}}) {
        const MatrixXd energy = c.weight * (motion.x.transpose() * (*form * motion.x) +
                                            motion.y.transpose() * (*form * motion.y));
        EXPECT_LT((energy - *of_model).norm(), 1e-9 * of_model->norm()) << order;
      }
    }
  }
}

TEST(HarmonicModel, CommutesWithAQuarterTurnToTheLastBit)
{
  const MirroredSector stiff(7), heavy(8);
  const SectorMatrices matrices{.K = stiff.form(), .M = heavy.form()};
  SectorDofs mirrored = stiff.dofs;
  mirrored.mirror = find_mirror(stiff.dofs, stiff.positions, {&matrices.K, &matrices.M});
  for (const SectorDofs* dofs : {&stiff.dofs, &std::as_const(mirrored)}) {
    const HarmonicCoordinates c = harmonic_coordinates(*dofs, 2);
    const HarmonicModel model = completely_reduced(matrices, c);
    const Index n = model.K.rows(), n_m = model.n_masters();
    MatrixXd J = MatrixXd::Zero(n, n);
    for (Index i = 0; i < n_m; ++i) {
      const auto row = std::size_t(c.masters[std::size_t(i)].coordinate);
      for (Index j = 0; j < n_m; ++j)
        if (c.masters[std::size_t(j)].coordinate == c.partner[row]) J(i, j) = c.sign[row];
    }
    for (Index k = n_m; k < n; k += 2) {
      J(k, k + 1) = -1.0;
      J(k + 1, k) = 1.0;
      EXPECT_EQ(model.omega[k - n_m], model.omega[k + 1 - n_m]);
    }
    EXPECT_EQ((J * J + MatrixXd::Identity(n, n)).norm(), 0.0);
    for (const MatrixXd* A : {&model.K, &model.M})
      EXPECT_EQ((J.transpose() * *A * J - *A).cwiseAbs().maxCoeff(), 0.0);
  }
}

TEST(HarmonicModel, KeepsNoModeWhereAllLieAboveTheCutoff)
{
  const MirroredSector stiff(7), heavy(8);
  const SectorMatrices matrices{.K = stiff.form(), .M = heavy.form()};
  const HarmonicCoordinates c = harmonic_coordinates(stiff.dofs, 1);
  const double lowest = completely_reduced(matrices, c).omega[0] / (2.0 * std::numbers::pi);
  reduce::PhaseListener silent;
  const auto n_modes = [&](double cutoff_Hz) {
    const HarmonicModel model = reduce_harmonic(
        matrices, c, {.basis = {.cutoff_Hz = cutoff_Hz}}, [](const Master&) { return false; },
        silent);
    EXPECT_EQ(model.K.rows(), model.n_masters() + model.omega.size());
    return model.omega.size();
  };
  EXPECT_EQ(n_modes(0.9 * lowest), 0);
  EXPECT_GE(n_modes(1.01 * lowest), 2);
}

}  // namespace
}  // namespace chladni::cyclic
