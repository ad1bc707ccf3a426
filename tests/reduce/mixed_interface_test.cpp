#include "reduce/mixed_interface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/petsc.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "reduce/error_estimates.hpp"
#include "reduce/partition.hpp"
#include "tests/linear/chain.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

using Eigen::MatrixXd;
using linear::testing::free_chain;
using linear::testing::master_set;

constexpr PetscInt n_of_mixed_chain = 60;
constexpr int n_mixed_modes = 7;

/// lambda_k = 4 sin^2(k pi / 2 n), k = 0, 1, ..., of the free chain.
double exact_of_chains(int k)
{
  return 4.0 * std::pow(std::sin(0.5 * k * std::numbers::pi / n_of_mixed_chain), 2);
}

/// The free chain with masters at an end and within, reduced by its own modes.
struct ReducedChain {
  linear::testing::Chain chain = free_chain(n_of_mixed_chain);
  DofPartition dofs = partition(chain.K, master_set(chain.K, {0, 23}));
  Blocks K = split(chain.K, dofs);
  Blocks M = split(chain.M, dofs);
  linear::Factorization K_ss = linear::factorize(K.ss);
  WholeSystem body{
      .K = chain.K, .M = chain.M, .dofs = dofs, .K_blocks = K, .M_blocks = M, .K_ss = K_ss};
  CraigBamptonBasis Q{.Psi = constraint_modes(K_ss, K), .modes = {}};
  MixedInterfaceModes free = mixed_interface_modes(body, Q.Psi, {.modes = n_mixed_modes});
};

/// Eigenvalues of M x = mu (K + M) x as lambda = 1 / mu - 1, ascending; infinite without mass.
std::vector<double> eigenvalues(const MatrixXd& K, const MatrixXd& M)
{
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(M, K + M);
  std::vector<double> lambda;
  for (Eigen::Index i = K.rows() - 1; i >= 0; --i) lambda.push_back(1 / eigen.eigenvalues()[i] - 1);
  return lambda;
}

TEST(MixedInterfaceModes, BeginWithTheRigidMotion)
{
  const ReducedChain reduced;
  EXPECT_EQ(reduced.free.n_rigid, 1);
  ASSERT_EQ(reduced.free.n_modes(), 1 + n_mixed_modes);
  EXPECT_EQ(reduced.free.omega[0], 0.0);
  for (int k = 1; k <= n_mixed_modes; ++k)
    EXPECT_NEAR(std::pow(reduced.free.omega[k], 2) / exact_of_chains(k), 1.0, 1e-9);
}

TEST(MixedInterfaceModes, AreRefusedBelowACutoffThatIsToldApartFromTheFirst)
{
  // The two masters of a held chain are 0 and 23, and 0 alone is held: no rigid motion.
  const ReducedChain reduced;
  const std::vector<int> held{0};
  const auto below = [&](double factor) {
    const double first = 2.0 * std::sin(0.5 * std::numbers::pi / (2 * n_of_mixed_chain - 1));
    const double cutoff_Hz = factor * first / (2.0 * std::numbers::pi);
    return testing::refused_numbers([&] {
      mixed_interface_modes(reduced.body, reduced.Q.Psi, {.cutoff_Hz = cutoff_Hz}, held);
    });
  };
  const std::vector<std::string> numbers = below(1.0 - 1e-8);
  ASSERT_EQ(numbers.size(), 2u);
  EXPECT_LT(std::stod(numbers[0]), std::stod(numbers[1]));
  EXPECT_TRUE(below(1.0 + 1e-8).empty());
}

TEST(Rubin, KeepsTheModesThatItIsMadeOf)
{
  ReducedChain reduced;
  reduced.Q.modes = residual_modes(reduced.body, reduced.free);
  const ReducedModel model = project(reduced.Q, reduced.K, reduced.M);
  // Two masters, the modes, and the inertia relief of one rigid motion.
  ASSERT_EQ(model.K.rows(), 2 + n_mixed_modes + 1);
  const std::vector<double> lambda = eigenvalues(model.K, model.M);
  EXPECT_NEAR(lambda[0], 0.0, 1e-12);
  for (int k = 1; k <= n_mixed_modes; ++k)
    EXPECT_NEAR(lambda[k] / exact_of_chains(k), 1.0, 1e-9) << "mode " << k;
}

TEST(Rubin, IsStaticallyCompleteAndDynamicallyToSecondOrder)
{
  ReducedChain reduced;
  reduced.Q.modes = residual_modes(reduced.body, reduced.free);
  const ReducedModel model = project(reduced.Q, reduced.K, reduced.M);
  // Receptance of the first mass to a force on it, full model: sum over all modes.
  const auto receptance = [](double omega2) {
    double sum = -1.0 / (n_of_mixed_chain * omega2);
    for (int k = 1; k < n_of_mixed_chain; ++k) {
      const double phi = std::sqrt(2.0 / n_of_mixed_chain) *
                         std::cos(0.5 * k * std::numbers::pi / n_of_mixed_chain);
      sum += phi * phi / (exact_of_chains(k) - omega2);
    }
    return sum;
  };
  double before = 0.0;
  for (const double omega2 : {1e-2, 1e-3}) {
    const MatrixXd D = model.K - omega2 * model.M;
    const double error = std::abs(D.partialPivLu().solve(MatrixXd::Identity(D.rows(), 1))(0, 0) -
                                  receptance(omega2));
    // The residual flexibility is exact at 0 and has the right slope: the error goes with omega^4.
    if (before > 0.0) {
      EXPECT_NEAR(before / error, 100.0, 15.0);
    }
    before = error;
  }
}

TEST(Rubin, HasCertifiedFrequenciesUnderASupport)
{
  ReducedChain reduced;
  reduced.Q.modes = residual_modes(reduced.body, reduced.free);
  const ReducedModel model = project(reduced.Q, reduced.K, reduced.M);
  const Eigen::Index n_r = model.K.rows();  // the first mass is held
  const MatrixXd K = model.K.bottomRightCorner(n_r - 1, n_r - 1);
  const MatrixXd M = model.M.bottomRightCorner(n_r - 1, n_r - 1);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(K, M);
  ReducedPairs pairs{.X = MatrixXd::Zero(n_r, 4), .lambda = {}};
  for (PetscInt j = 0; j < 4; ++j) {
    pairs.lambda.push_back(eigen.eigenvalues()[j]);
    for (PetscInt i = 1; i < n_r; ++i) pairs.X(i, j) = eigen.eigenvectors()(i - 1, j);
  }
  const std::vector<double> eta2 =
      error_estimates({reduced.K_ss, reduced.Q, reduced.K, reduced.M}, pairs).eta2;
  for (PetscInt j = 0; j < 4; ++j) {
    const double held =
        4.0 *
        std::pow(std::sin((2 * j + 1) * std::numbers::pi / (2.0 * (2 * n_of_mixed_chain - 1))),
                 2);  // one end held
    const double error = pairs.lambda[j] / held - 1.0;
    EXPECT_NEAR(eta2[j], error, 0.2 * error + 1e-11) << "mode " << j + 1;
  }
}

/// 4 sin^2((2 k - 1) pi / (2 (2 n - 1))), k = 1, 2, ..., of the chain with one end held.
double exact_with_end_held(int k)
{
  return 4.0 *
         std::pow(std::sin((2 * k - 1) * std::numbers::pi / (2.0 * (2 * n_of_mixed_chain - 1))), 2);
}

/// A mode of a master that nothing couples is a constraint mode: the residual flexibility adds
/// nothing for it, and round-off is no direction of the basis, whatever the number of ranks.
TEST(Rubin, AddsNothingForAMasterThatMovesAlone)
{
  constexpr PetscInt n_rows = n_of_mixed_chain + 1;
  constexpr double hardly_coupled = 1e-13;
  const double second =
      4.0 * std::pow(std::sin(1.5 * std::numbers::pi / (2 * n_of_mixed_chain + 1)), 2);
  for (const double apart : {1e-5, 1e-3, 1e-2}) {  // from a mode of the chain, which it mixes with
    const double k = second * (1.0 + apart);
    const petsc::Matrix K_all = linear::testing::matrix(n_rows, 4, [&](PetscInt i) {
      if (i == n_of_mixed_chain)
        return linear::testing::Row{{n_of_mixed_chain / 2, -hardly_coupled}, {i, k}};
      linear::testing::Row row{{i, i + 1 < n_of_mixed_chain ? 2.0 : 1.0}};
      if (i > 0) row.emplace_back(i - 1, -1.0);
      if (i + 1 < n_of_mixed_chain) row.emplace_back(i + 1, -1.0);
      if (i == n_of_mixed_chain / 2) row.emplace_back(n_of_mixed_chain, -hardly_coupled);
      return row;
    });
    const petsc::Matrix M_all = linear::testing::diagonal(n_rows, [](PetscInt) { return 1.0; });
    const DofPartition dofs = partition(K_all, master_set(K_all, {0, n_of_mixed_chain}));
    const Blocks K = split(K_all, dofs), M = split(M_all, dofs);
    const linear::Factorization K_ss = linear::factorize(K.ss);
    const petsc::Matrix Psi = constraint_modes(K_ss, K);
    const WholeSystem body{
        .K = K_all, .M = M_all, .dofs = dofs, .K_blocks = K, .M_blocks = M, .K_ss = K_ss};
    const MixedInterfaceModes modes = mixed_interface_modes(body, Psi, {.modes = 5});
    ASSERT_EQ(modes.n_modes(), 5);
    EXPECT_EQ(residual_modes(body, modes).omega.size(), 4u) << "apart by " << apart;
  }
}

TEST(MixedInterfaceModes, AreThoseOfTheBodyWithTheHeldMasters)
{
  const ReducedChain reduced;
  const MixedInterfaceModes modes =
      mixed_interface_modes(reduced.body, reduced.Q.Psi, {.modes = n_mixed_modes}, {0});
  EXPECT_EQ(modes.n_rigid, 0);
  ASSERT_EQ(modes.n_modes(), n_mixed_modes);
  EXPECT_EQ(modes.X_m.row(0).norm(), 0.0);
  EXPECT_GT(modes.X_m.row(1).norm(), 0.1);
  for (int k = 1; k <= n_mixed_modes; ++k)
    EXPECT_NEAR(std::pow(modes.omega[k - 1], 2) / exact_with_end_held(k), 1.0, 1e-9);
}

TEST(MixedInterfaceModes, OfAToleranceAreThoseOfItsRange)
{
  const ReducedChain reduced;
  const double between =
      0.5 * (std::sqrt(exact_with_end_held(4)) + std::sqrt(exact_with_end_held(5)));
  const MixedInterfaceModes modes = mixed_interface_modes(
      reduced.body, reduced.Q.Psi,
      {.tolerance =
           ModesByTolerance{.tolerance = 0.1, .up_to_Hz = between / (2.0 * std::numbers::pi)}},
      {0});
  EXPECT_EQ(modes.n_modes(), 4);
}

/// With its first mass held, of a model whose first coordinate is that mass.
std::vector<double> eigenvalues_with_end_held(const ReducedModel& model)
{
  const Eigen::Index n_r = model.K.rows() - 1;
  return eigenvalues(model.K.bottomRightCorner(n_r, n_r), model.M.bottomRightCorner(n_r, n_r));
}

/// Two free chains like those above that lie into each other, and a mass that nothing holds.
struct TwoMixedChains {
  static constexpr PetscInt n_rows = 2 * n_of_mixed_chain + 1;
  petsc::Matrix K = linear::testing::matrix(n_rows, 3, [](PetscInt i) {
    const PetscInt place = i / 2;
    linear::testing::Row row;
    if (place == n_of_mixed_chain) return linear::testing::Row{{i, 0.0}};
    row.emplace_back(i, (place > 0) + (place + 1 < n_of_mixed_chain));
    if (place > 0) row.emplace_back(i - 2, -1.0);
    if (place + 1 < n_of_mixed_chain) row.emplace_back(i + 2, -1.0);
    return row;
  });
  petsc::Matrix M = linear::testing::diagonal(n_rows, [](PetscInt) { return 1.0; });
};

struct ReducedTwoChains {
  TwoMixedChains chains;
  DofPartition dofs =
      partition(chains.K, master_set(chains.K, {0, 1, 46, 47, 2 * n_of_mixed_chain}));
  Blocks K = split(chains.K, dofs), M = split(chains.M, dofs);
  linear::Factorization K_ss = linear::factorize(K.ss);
  petsc::Matrix Psi = constraint_modes(K_ss, K);
  WholeSystem body{
      .K = chains.K, .M = chains.M, .dofs = dofs, .K_blocks = K, .M_blocks = M, .K_ss = K_ss};
};

/// Some of the first masses of both chains held, rows 0 and 1, and the mass without a spring, 4.
using Held = std::vector<int>;

/// The n lowest eigenvalues but zero of each chain, ascending.
std::vector<double> elastic(const Held& held, int n_of_each)
{
  std::vector<double> lambda;
  for (const int first_mass : {0, 1}) {
    const bool is_held = std::ranges::find(held, first_mass) != held.end();
    for (int k = 1; k <= n_of_each; ++k)
      lambda.push_back(is_held ? exact_with_end_held(k) : exact_of_chains(k));
  }
  std::ranges::sort(lambda);
  return lambda;
}

TEST(MixedInterfaceModes, OfPartsWithTheSameFrequenciesMoveOnePartEach)
{
  const ReducedTwoChains two;
  const std::vector<PetscInt> rows = petsc::own_indices(two.dofs.slaves);
  for (const Held& held : {Held{}, {0, 4}, {0, 1, 4}}) {
    const MixedInterfaceModes modes =
        mixed_interface_modes(two.body, two.Psi, {.modes = 2 * n_mixed_modes}, held);
    const std::vector<double> lambda = elastic(held, n_mixed_modes);
    ASSERT_EQ(modes.n_rigid, 3 - std::ssize(held));
    ASSERT_EQ(modes.n_modes() - modes.n_rigid, std::ssize(lambda));
    MatrixXd sums = MatrixXd::Zero(modes.n_modes(), 2);  // of each chain
    const linear::LocalRows X_s(modes.X_s);
    for (PetscInt k = 0; k < modes.n_modes(); ++k)
      for (PetscInt i = 0; i < X_s.n_rows(); ++i)
        sums(k, rows[std::size_t(i)] % 2) += std::abs(X_s(i, k));
    linear::sum_over_ranks(linear::values_of(sums), PETSC_COMM_WORLD);
    for (PetscInt k = modes.n_rigid; k < modes.n_modes(); ++k) {
      EXPECT_NEAR(std::pow(modes.omega[k], 2) / lambda[k - modes.n_rigid], 1.0, 1e-9) << k;
      EXPECT_EQ(sums.row(k).minCoeff(), 0.0) << "mode " << k;
      EXPECT_GT(sums.row(k).maxCoeff(), 1.0) << "mode " << k;
    }
  }
}

TEST(MixedInterfaceModes, OfPartsAreNoMoreThanTheElasticOnes)
{
  const ReducedTwoChains two;
  for (const Held& held : {Held{}, {0}, {1, 4}}) {
    constexpr double above_all = 5.0;
    const std::vector<double> lambda = elastic(held, n_of_mixed_chain - 1);  // held or not
    const auto n_all = static_cast<PetscInt>(lambda.size());
    for (const ReduceOptions& wanted :
         {ReduceOptions{.modes = n_all},
          ReduceOptions{.cutoff_Hz = std::sqrt(above_all) / (2.0 * std::numbers::pi)}}) {
      const MixedInterfaceModes modes = mixed_interface_modes(two.body, two.Psi, wanted, held);
      ASSERT_EQ(modes.n_rigid, 3 - std::ssize(held));
      ASSERT_EQ(modes.n_modes() - modes.n_rigid, n_all);
      for (PetscInt k = 0; k < n_all; ++k)
        EXPECT_NEAR(std::pow(modes.omega[modes.n_rigid + k], 2) / lambda[k], 1.0, 1e-9) << k;
    }
    EXPECT_THROW(mixed_interface_modes(two.body, two.Psi, {.modes = n_all + 1}, held), Error);
  }
}

/// A held mass has a share of M that the flexibility maps to zero, and a row without mass leaves a
/// part fewer modes than free rows: what round-off makes of the rest, of either sign, is no mode.
TEST(MixedInterfaceModes, OfPartsWithMasslessRowsAreThoseOfTheMasses)
{
  constexpr PetscInt n_parts = 24;  // mass, row without mass, held mass
  const auto stiffness = [](PetscInt row) { return 1.0 + std::fmod(0.37 * double(row), 3.0); };
  const petsc::Matrix K_all = linear::testing::matrix(3 * n_parts, 3, [&](PetscInt i) {
    const PetscInt place = i % 3, first = i - place;
    const double near = stiffness(first), far = stiffness(first + 1);
    if (place == 0) return linear::testing::Row{{i, near}, {i + 1, -near}};
    if (place == 1) return linear::testing::Row{{i - 1, -near}, {i, near + far}, {i + 1, -far}};
    return linear::testing::Row{{i - 1, -far}, {i, far}};
  });
  const petsc::Matrix M_all = linear::testing::diagonal(
      3 * n_parts, [](PetscInt i) { return i % 3 == 1 ? 0.0 : 1.0 + 0.1 * double(i % 7); });
  std::vector<PetscInt> masters;
  std::vector<int> held;
  std::vector<double> lambda;
  for (PetscInt p = 0; p < n_parts; ++p) {
    const double near = stiffness(3 * p), far = stiffness(3 * p + 1);
    lambda.push_back(near * far / (near + far) / (1.0 + 0.1 * double(3 * p % 7)));
    masters.push_back(3 * p + 2);
    held.push_back(static_cast<int>(p));
  }
  std::ranges::sort(lambda);
  const DofPartition dofs = partition(K_all, master_set(K_all, masters));
  const Blocks K = split(K_all, dofs), M = split(M_all, dofs);
  const linear::Factorization K_ss = linear::factorize(K.ss);
  const petsc::Matrix Psi = constraint_modes(K_ss, K);
  const WholeSystem body{
      .K = K_all, .M = M_all, .dofs = dofs, .K_blocks = K, .M_blocks = M, .K_ss = K_ss};
  for (const ReduceOptions& wanted :
       {ReduceOptions{.modes = n_parts}, ReduceOptions{.cutoff_Hz = 1e30}}) {
    const MixedInterfaceModes modes = mixed_interface_modes(body, Psi, wanted, held);
    ASSERT_EQ(modes.n_modes(), n_parts);
    for (PetscInt k = 0; k < n_parts; ++k)
      EXPECT_NEAR(std::pow(modes.omega[k], 2) / lambda[k], 1.0, 1e-9) << k;
  }
  EXPECT_THROW(mixed_interface_modes(body, Psi, {.modes = n_parts + 1}, held), Error);
}

TEST(MixedInterface, KeepsTheModesUnderItsSupport)
{
  ReducedChain reduced;
  const MixedInterfaceModes modes =
      mixed_interface_modes(reduced.body, reduced.Q.Psi, {.modes = n_mixed_modes}, {0});
  reduced.Q.modes = residual_modes(reduced.body, modes);
  const ReducedModel model = project(reduced.Q, reduced.K, reduced.M);
  ASSERT_EQ(model.K.rows(), 2 + n_mixed_modes);
  const std::vector<double> lambda = eigenvalues_with_end_held(model);
  for (int k = 1; k <= n_mixed_modes; ++k)
    EXPECT_NEAR(lambda[k - 1] / exact_with_end_held(k), 1.0, 1e-9) << "mode " << k;
}

TEST(MixedInterface, IsExactUnderForcesAtEachMasterAndOtherSupports)
{
  ReducedChain reduced;
  const MixedInterfaceModes modes =
      mixed_interface_modes(reduced.body, reduced.Q.Psi, {.modes = n_mixed_modes}, {0});
  reduced.Q.modes = residual_modes(reduced.body, modes);
  const ReducedModel model = project(reduced.Q, reduced.K, reduced.M);
  // The spring between both masters, 23 of stiffness 1 in series.
  EXPECT_NEAR(model.K(0, 0), 1.0 / 23.0, 1e-14);
  // Free, it is no worse than static condensation, and near the truth.
  const std::vector<double> free = eigenvalues(model.K, model.M);
  EXPECT_NEAR(free[0], 0.0, 1e-12);
  for (int k = 1; k < 4; ++k) EXPECT_NEAR(free[k] / exact_of_chains(k), 1.0, 1e-2) << "mode " << k;
}

TEST(MixedInterface, WithAllMastersHeldIsCraigAndBampton)
{
  ReducedChain reduced;
  const MixedInterfaceModes modes =
      mixed_interface_modes(reduced.body, reduced.Q.Psi, {.modes = n_mixed_modes}, {0, 1});
  const FixedInterfaceModes residual = residual_modes(reduced.body, modes);
  const FixedInterfaceModes fixed =
      fixed_interface_modes(reduced.K_ss, reduced.M.ss, {.modes = n_mixed_modes});
  ASSERT_EQ(residual.omega.size(), fixed.omega.size());
  for (std::size_t k = 0; k < fixed.omega.size(); ++k)
    EXPECT_NEAR(residual.omega[k] / fixed.omega[k], 1.0, 1e-10);
}

}  // namespace
}  // namespace chladni::reduce
