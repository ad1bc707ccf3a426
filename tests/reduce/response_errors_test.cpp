#include "reduce/response_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/petsc_compat.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "reduce/fixed_interface_modes.hpp"
#include "reduce/moving_slaves.hpp"
#include "reduce/residual_forms.hpp"
#include "tests/linear/chain.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using linear::testing::free_chain;
using linear::testing::master_set;

constexpr PetscInt n = 60;
constexpr int n_modes = 5;

/// The chain held at its first mass and loaded at two others, by its modes under that support.
struct LoadedChain {
  linear::testing::Chain chain = free_chain(n);
  DofPartition dofs = partition(chain.K, master_set(chain.K, {0, 23, 59}));
  Blocks K = split(chain.K, dofs);
  Blocks M = split(chain.M, dofs);
  linear::Factorization K_ss = linear::factorize(K.ss);
  WholeSystem body{
      .K = chain.K, .M = chain.M, .dofs = dofs, .K_blocks = K, .M_blocks = M, .K_ss = K_ss};
  CraigBamptonBasis Q{.Psi = constraint_modes(K_ss, K), .modes = {}};
  std::vector<int> held{0};
  MixedInterfaceModes modes = mixed_interface_modes(body, Q.Psi, {.modes = n_modes}, held);
  ReducedModel model = reduced();
  MatrixXd F = MatrixXd::Identity(3, 3).rightCols(2);

  ReducedModel reduced()
  {
    Q.modes = residual_modes(body, modes);
    return project(Q, K, M);
  }
  GrowingBasis growing() { return {.K_ss = K_ss, .K = K, .M = M, .Q_CB = Q, .model = model}; }

  /// Responses x of the reduced model, zero at the held mass.
  MatrixXd responses(double Omega) const
  {
    const Eigen::Index m = model.K.rows() - 1;
    const MatrixXd A = (model.K - Omega * Omega * model.M).bottomRightCorner(m, m);
    MatrixXd loads = MatrixXd::Zero(m, 2);
    loads.topRows(2) = MatrixXd::Identity(2, 2);
    MatrixXd X = MatrixXd::Zero(m + 1, 2);
    X.bottomRows(m) = A.partialPivLu().solve(loads);
    return X;
  }
  /// u of the FE model less that of the reduced one.
  MatrixXd error(double Omega) const
  {
    MatrixXd A = -Omega * Omega * MatrixXd::Identity(n - 1, n - 1);  // masses 1 .. n - 1
    for (int i = 0; i < n - 1; ++i) {
      A(i, i) += i == n - 2 ? 1.0 : 2.0;
      if (i > 0) A(i, i - 1) = A(i - 1, i) = -1.0;
    }
    MatrixXd loads = MatrixXd::Zero(n - 1, 2);
    loads(22, 0) = loads(58, 1) = 1.0;
    return loads.transpose() * A.partialPivLu().solve(loads) - responses(Omega).middleRows(1, 2);
  }
};

/// Of a symmetric matrix.
VectorXd eigenvalues(const MatrixXd& A)
{
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

TEST(ResponseErrors, LieBetweenTheirEstimateAndItsMultiple)
{
  LoadedChain loaded;
  const double left_out = loaded.modes.lambda_left_out;
  for (const double share : {0.2, 0.5, 0.8, 0.95}) {
    const double Omega = share * std::sqrt(left_out);
    const MatrixXd E = loaded.error(Omega);
    const MatrixXd G =
        ResidualForms(loaded.growing()).energy(loaded.responses(Omega), Omega * Omega);
    const double c = 1.0 / (1.0 - share * share), round_off = 1e-9 * E.norm() + 1e-13;
    EXPECT_GT(eigenvalues(E - G).minCoeff(), -round_off) << share;
    EXPECT_GT(eigenvalues(c * G - E).minCoeff(), -round_off) << share;
    const VectorXd bounds = response_error_bounds(G, Omega, left_out);
    for (int j = 0; j < 2; ++j) {
      EXPECT_GT(bounds[j], (1.0 - 1e-9) * E.col(j).norm() - 1e-13);
      EXPECT_LT(bounds[j], 2.0 * c * E.col(j).norm() + 1e-13);
    }
  }
}

TEST(ResidualForms, HaveTheShapesThatTheyMeasure)
{
  LoadedChain loaded;
  const double s = 0.5 * loaded.modes.lambda_left_out;
  const ResidualForms forms(loaded.growing());
  const MatrixXd X = loaded.responses(std::sqrt(s));
  const petsc::Matrix z = forms.shapes(X, s);  // K_ss z = r: its energy is that of the residual
  petsc::Matrix r;
  petsc::check(MatMatMult(loaded.K.ss, z, MAT_INITIAL_MATRIX, petsc::automatic, r.put()));
  const MatrixXd G = forms.energy(X, s);
  EXPECT_LT((linear::inner_product(z, r) - G).norm(), 1e-10 * G.norm());
}

TEST(ResidualForms, GrowWithTheBasis)
{
  LoadedChain loaded;
  const double s = 0.5 * loaded.modes.lambda_left_out;
  ResidualForms forms(loaded.growing());
  forms.append(forms.shapes(loaded.responses(std::sqrt(s)), s));
  const double Omega = 0.8 * std::sqrt(s);
  const MatrixXd X = loaded.responses(Omega);
  const MatrixXd grown = forms.energy(X, Omega * Omega);
  forms.make_ritz();
  EXPECT_EQ(loaded.model.K.rows(), 3 + n_modes + 2);
  const ReducedModel anew = project(loaded.Q, loaded.K, loaded.M);
  EXPECT_LT((anew.K - loaded.model.K).norm(), 1e-11 * anew.K.norm());
  EXPECT_LT((anew.M - loaded.model.M).norm(), 1e-11 * anew.M.norm());
  const MatrixXd G = ResidualForms(loaded.growing()).energy(loaded.responses(Omega), Omega * Omega);
  EXPECT_LT((grown - G).norm(), 1e-9 * X.norm());
}

TEST(ResidualForms, NeedNoMastersThatStandStill)
{
  LoadedChain loaded, same, still;
  const double s = 0.5 * loaded.modes.lambda_left_out;
  GrowingBasis of_some = same.growing(), of_none = still.growing();
  of_some.moving = {1, 2};
  of_none.moving.emplace();
  ResidualForms all(loaded.growing()), some(of_some);
  const MatrixXd X = loaded.responses(std::sqrt(s)), G = all.energy(X, s);
  EXPECT_LT((some.energy(X, s) - G).norm(), 1e-14 * X.squaredNorm());  // a difference of energies
  all.append(all.shapes(X, s));
  some.append(some.shapes(X, s));
  const MatrixXd Y = loaded.responses(0.8 * std::sqrt(s)), H = all.energy(Y, 0.64 * s);
  EXPECT_LT((some.energy(Y, 0.64 * s) - H).norm(), 1e-9 * Y.norm());
  MatrixXd in_modes = X;
  in_modes.topRows(3).setZero();
  const MatrixXd of_modes = ResidualForms(still.growing()).energy(in_modes, s);
  EXPECT_LT((ResidualForms(of_none).energy(in_modes, s) - of_modes).norm(),
            1e-13 * of_modes.norm());
}

/// Two chains that lie into each other, each between fixed ends, with masters in both.
struct TwoChains {
  petsc::Matrix K_all = chains(2.1, -1.0), M_all = chains(1.0, 0.1);
  DofPartition dofs = partition(K_all, master_set(K_all, {10, 21, 60, 83}));
  Blocks K = split(K_all, dofs), M = split(M_all, dofs);
  linear::Factorization K_ss = linear::factorize(K.ss);
  CraigBamptonBasis Q{.Psi = constraint_modes(K_ss, K),
                      .modes = fixed_interface_modes(K_ss, M.ss, {.modes = 6})};
  ReducedModel model = project(Q, K, M);

  static petsc::Matrix chains(double diagonal, double beside)
  {
    constexpr PetscInt n_rows = 120;
    return linear::testing::matrix(n_rows, 3, [&](PetscInt i) {
      linear::testing::Row row{{i, diagonal}};
      if (i >= 2) row.emplace_back(i - 2, beside);
      if (i + 2 < n_rows) row.emplace_back(i + 2, beside);
      return row;
    });
  }
  GrowingBasis growing(std::vector<int> moving)
  {
    return {.K_ss = K_ss, .K = K, .M = M, .Q_CB = Q, .model = model, .moving = std::move(moving)};
  }
  /// Responses to forces at the even masters, which are the first and the third.
  MatrixXd responses(double s) const
  {
    MatrixXd F = MatrixXd::Zero(model.K.rows(), 2);
    F(0, 0) = F(2, 1) = 1.0;
    return (model.K - s * model.M).partialPivLu().solve(F);
  }
};

TEST(ResidualForms, OfAPartThatMovesAreThoseOfTheWhole)
{
  TwoChains of_part, of_all;
  const MovingSlaves even(of_part.K_ss, of_part.M, of_part.Q, {0, 2});
  if (petsc::size(PETSC_COMM_WORLD) == 1) {  // fronts that ranks share may mix the chains
    EXPECT_FALSE(even.are_all());
    EXPECT_EQ(even.masters(), (std::vector<int>{0, 2}));
  }
  ResidualForms part(of_part.growing({0, 2})), all(of_all.growing({0, 1, 2, 3}));
  const double s = 0.02;
  const MatrixXd X = of_all.responses(s), G = all.energy(X, s);
  EXPECT_GT(G.norm(), 1e-6 * X.squaredNorm());
  EXPECT_LT((part.energy(X, s) - G).norm(), 1e-13 * X.squaredNorm());
  part.append(part.shapes(X, s));
  all.append(all.shapes(X, s));
  const MatrixXd Y = of_all.responses(0.5 * s), H = all.energy(Y, 0.5 * s);
  EXPECT_LT((part.energy(Y, 0.5 * s) - H).norm(), 1e-13 * Y.squaredNorm());
  part.make_ritz();
  const ReducedModel anew = project(of_part.Q, of_part.K, of_part.M);
  EXPECT_LT((anew.K - of_part.model.K).norm(), 1e-12 * anew.K.norm());
  EXPECT_LT((anew.M - of_part.model.M).norm(), 1e-12 * anew.M.norm());
}

/// Errors relative to the static response.
ResponseGoal goal_of(const LoadedChain& loaded, double tolerance)
{
  const double end = 0.9 * std::sqrt(loaded.modes.lambda_left_out);
  const VectorXd Omega = VectorXd::LinSpaced(9, end / 9.0, end);
  return {
      .Omega = end, .tolerance = tolerance, .loads = [F = loaded.F, Omega](const ReducedModel&) {
        return ResponseLoads{.F = F, .Omega = Omega, .size = MatrixXd::Constant(2, 9, 10.0)};
      }};
}

TEST(ResponseErrors, AreKeptBelowATolerance)
{
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    LoadedChain loaded;
    const ResponseGoal goal = goal_of(loaded, tolerance);
    const ResponseCertificate found = keep_responses(
        loaded.body, {loaded.Q, loaded.model}, loaded.held, loaded.modes.lambda_left_out, goal);
    EXPECT_LE(found.error, tolerance);
    EXPECT_EQ(loaded.model.K.rows(), 3 + std::ssize(loaded.model.omega));
    EXPECT_LE(loaded.model.omega.size(), std::size_t(n_modes + 24));
    double largest = 0.0;
    for (int i = 1; i <= 50; ++i) {  // between the frequencies that were looked at, too
      const MatrixXd error = loaded.error(i / 50.0 * goal.Omega) / 10.0;
      largest = std::max(largest, error.colwise().norm().maxCoeff());
    }
    constexpr double resonant = 1e-9;  // what the eigen-solver left of the modes, near resonances
    EXPECT_LE(largest, std::max(1.2 * found.error, resonant));
    EXPECT_GT(largest + 1e-12, 0.1 * found.error);  // which tells something
  }
}

TEST(ResponseErrors, AreKeptOfLoadsOfDifferentKinds)
{
  // Moments beside forces: the errors that one is allowed are large for the other's bound.
  for (const double ratio : {1e-4, 1e4, 1e8}) {
    LoadedChain loaded;
    ResponseGoal goal = goal_of(loaded, 1e-6);
    goal.loads = [loads = goal.loads(loaded.model), ratio](const ReducedModel&) {
      ResponseLoads unlike = loads;
      unlike.size.row(1) *= ratio;
      return unlike;
    };
    const ResponseCertificate found = keep_responses(
        loaded.body, {loaded.Q, loaded.model}, loaded.held, loaded.modes.lambda_left_out, goal);
    EXPECT_LE(found.error, 1e-6) << ratio;
  }
}

TEST(ResponseErrors, NeedTheModesOfTheRange)
{
  LoadedChain loaded;
  ResponseGoal goal = goal_of(loaded, 1e-3);
  goal.Omega = 1.1 * std::sqrt(loaded.modes.lambda_left_out);
  EXPECT_THROW(keep_responses(loaded.body, {loaded.Q, loaded.model}, loaded.held,
                              loaded.modes.lambda_left_out, goal),
               Error);
}

}  // namespace
}  // namespace chladni::reduce
