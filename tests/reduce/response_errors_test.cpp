#include "reduce/response_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "common/petsc.hpp"
#include "linear/cholesky/part_solver.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/response_error.hpp"
#include "mbs_export/select_by_tolerance.hpp"
#include "pencils.hpp"
#include "reduce/fixed_interface_modes.hpp"
#include "reduce/residual_forms.hpp"
#include "reduce/unbalanced_forces.hpp"
#include "tests/linear/chain.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

using Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;
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
VectorXd symmetric_eigenvalues(const MatrixXd& A)
{
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

TEST(ResponseErrors, LieBetweenTheirEstimateAndItsMultiple)
{
  LoadedChain loaded;
  const double left_out = loaded.modes.lambda_left_out;
  const ResidualForms forms(loaded.growing());
  for (const double share : {0.2, 0.5, 0.8, 0.95}) {
    const double Omega = share * std::sqrt(left_out);
    const MatrixXd E = loaded.error(Omega);
    const MatrixXd G = forms.energy(loaded.responses(Omega), Omega * Omega);
    const double c = 1.0 / (1.0 - share * share), round_off = 1e-9 * E.norm() + 1e-13;
    EXPECT_GT(symmetric_eigenvalues(E - G).minCoeff(), -round_off) << share;
    EXPECT_GT(symmetric_eigenvalues(c * G - E).minCoeff(), -round_off) << share;
  }
}

TEST(UnbalancedForces, BoundErrorsUpToTheFirstModeThatIsLeftOut)
{
  LoadedChain loaded;
  const double left_out = loaded.modes.lambda_left_out;
  const ResidualForms forms(loaded.growing());
  for (const double share : {0.2, 0.5, 0.8, 0.95, 0.999}) {
    const double Omega = share * std::sqrt(left_out);
    const UnbalancedForces forces({.forms = forms,
                                   .model = loaded.model,
                                   .still = loaded.held,
                                   .lambda_left_out = left_out,
                                   .lambda_of_range = Omega * Omega},
                                  loaded.F);
    const MatrixXd E = loaded.error(Omega);
    const VectorXd bounds =
        forces.error_bounds({.from = (1.0 - 1e-9) * Omega, .to = Omega, .loss_factor = 0.0});
    const double c = 1.0 / (1.0 - share * share);
    for (int j = 0; j < 2; ++j) {
      EXPECT_GT(bounds[j], (1.0 - 1e-6) * E.col(j).norm()) << share;
      EXPECT_LT(bounds[j], 2.0 * c * E.col(j).norm()) << share;
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

TEST(ResidualForms, AreTheSameWithAFactorThatSolvesAsAWholeAlone)
{
  const char* option = "-cms_pc_factor_mat_solver_type";
  LoadedChain ours;
  petsc::check(PetscOptionsSetValue(nullptr, option, "mumps-metis"));
  LoadedChain by_mumps;
  petsc::check(PetscOptionsClearValue(nullptr, option));
  ASSERT_TRUE(linear::halves(ours.K_ss.factor()));
  ASSERT_FALSE(linear::halves(by_mumps.K_ss.factor()));
  const double s = 0.5 * ours.modes.lambda_left_out;
  const auto energy = [s](LoadedChain& loaded) {
    return ResidualForms(loaded.growing()).energy(loaded.responses(std::sqrt(s)), s);
  };
  const MatrixXd expected = energy(ours);
  EXPECT_LT((energy(by_mumps) - expected).norm(), 1e-9 * expected.norm());
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
struct TwoLoadedChains {
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
  TwoLoadedChains of_part, of_all;
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
  const VectorXd Omega = VectorXd::LinSpaced(10, 0.0, end);
  return {
      .Omega = end, .tolerance = tolerance, .loads = [F = loaded.F, Omega](const ReducedModel&) {
        return ResponseLoads{
            .F = F, .Omega = Omega, .size = MatrixXd::Constant(2, 9, 10.0), .loss_factor = 0.0};
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
    EXPECT_LE(largest, std::max(found.error, resonant));
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

/// A body of point masses on a tree of springs and some more, held at one mass and loaded at
/// others.
struct RandomBody {
  MatrixXd K, M;
  std::vector<PetscInt> masters;  ///< the first one is held
  int n_modes;
  double share;  ///< of the range in what the modes allow

  explicit RandomBody(unsigned seed) : draw_(seed)
  {
    const int n = integer(15, 60);
    K = M = MatrixXd::Zero(n, n);
    const double stiffest = std::pow(10.0, number(0.0, 3.0)), widest = number(0.0, 2.0);
    for (int i = 0; i < n; ++i) M(i, i) = std::pow(10.0, number(0.0, widest));
    for (int i = 1; i < n; ++i)
      add_spring(integer(0, 1) == 0 ? i - 1 : integer(0, i - 1), i, stiffest);
    for (int k = integer(0, n); k > 0; --k)
      add_spring(integer(0, n - 1), integer(0, n - 1), stiffest);
    for (const int k = integer(2, 4); std::ssize(masters) < k;) {
      const int i = integer(0, n - 1);
      if (std::ranges::count(masters, i) == 0) masters.push_back(i);
    }
    n_modes = integer(1, n / 4);
    share = number(0.75, 0.99);
  }

 private:
  void add_spring(int i, int j, double stiffest)
  {
    const double k = std::pow(stiffest, number(0.0, 1.0));
    if (i == j) return;
    K(i, i) += k;
    K(j, j) += k;
    K(i, j) -= k;
    K(j, i) -= k;
  }
  double number(double low, double high)
  {
    return low + (high - low) * (static_cast<double>(draw_()) * 0x1p-32);
  }
  int integer(int first, int last)
  {
    return first + static_cast<int>((static_cast<double>(draw_()) * 0x1p-32) * (last - first + 1));
  }

  std::mt19937 draw_;
};

petsc::Matrix sparse(const MatrixXd& A)
{
  const auto n = static_cast<PetscInt>(A.rows());
  return linear::testing::matrix(n, n, [&](PetscInt i) {
    linear::testing::Row row;
    for (PetscInt j = 0; j < n; ++j)
      if (A(i, j) != 0.0 || i == j) row.emplace_back(j, A(i, j));
    return row;
  });
}

/// Responses at loads by all modes of a body, and of a model of it.
struct Modal {
  VectorXd lambda;
  MatrixXd B;  ///< [n x l] at the loads

  Modal(const MatrixXd& K, const MatrixXd& M, const MatrixXd& F)
  {
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(K, M);
    lambda = modes.eigenvalues();
    B = modes.eigenvectors().transpose() * F;
  }
  MatrixXcd responses(double Omega, double eta) const
  {
    const Eigen::VectorXcd d =
        std::complex(1.0, eta) * lambda.array() - std::complex(Omega * Omega, 0.0);
    return B.transpose() * d.cwiseInverse().asDiagonal() * B;
  }
  /// |H e_j|, or the root sum of squares of what modes contribute if that is larger.
  VectorXd sizes(double Omega, double eta) const
  {
    const Eigen::VectorXcd d =
        std::complex(1.0, eta) * lambda.array() - std::complex(Omega * Omega, 0.0);
    const VectorXd weight = B.rowwise().squaredNorm().array() / d.array().abs2();
    const VectorXd incoherent = (B.cwiseAbs2().transpose() * weight).cwiseSqrt();
    return responses(Omega, eta).colwise().norm().transpose().cwiseMax(incoherent);
  }
};

std::vector<int> all_rows_but(Eigen::Index n, int row)
{
  std::vector<int> others;
  for (int i = 0; i < n; ++i)
    if (i != row) others.push_back(i);
  return others;
}

/// A random body by its modes under its support.
struct ReducedRandomBody {
  static constexpr double eta = 0.02;

  RandomBody drawn;
  petsc::Matrix K_all = sparse(drawn.K), M_all = sparse(drawn.M);
  DofPartition dofs = partition(K_all, master_set(K_all, drawn.masters));
  Blocks K = split(K_all, dofs);
  Blocks M = split(M_all, dofs);
  linear::Factorization K_ss = linear::factorize(K.ss);
  WholeSystem body{
      .K = K_all, .M = M_all, .dofs = dofs, .K_blocks = K, .M_blocks = M, .K_ss = K_ss};
  std::vector<int> held{place(drawn.masters.front())};
  CraigBamptonBasis Q{.Psi = constraint_modes(K_ss, K), .modes = {}};
  MixedInterfaceModes modes = mixed_interface_modes(body, Q.Psi, {.modes = drawn.n_modes}, held);
  ReducedModel model = reduced();
  double end = drawn.share * std::sqrt(modes.lambda_left_out) / 1.15;

  ReducedModel reduced()
  {
    Q.modes = residual_modes(body, modes);
    return project(Q, K, M);
  }
  /// Of a master among all.
  int place(PetscInt master) const
  {
    return static_cast<int>(
        std::ranges::count_if(drawn.masters, [&](PetscInt i) { return i < master; }));
  }
  Eigen::Index n_loads() const { return std::ssize(drawn.masters) - 1; }
  /// Unit loads on all masters but the held one.
  MatrixXd loads(Eigen::Index n_rows, bool of_model) const
  {
    MatrixXd F = MatrixXd::Zero(n_rows, n_loads());
    for (Eigen::Index j = 0; j < n_loads(); ++j) {
      const PetscInt i = drawn.masters[std::size_t(j + 1)];
      F(of_model ? place(i) : i, j) = 1.0;
    }
    return F;
  }
  Modal exact() const
  {
    const auto free = all_rows_but(drawn.K.rows(), static_cast<int>(drawn.masters.front()));
    return {drawn.K(free, free), drawn.M(free, free),
            loads(drawn.K.rows(), false)(free, Eigen::all)};
  }
  Modal of(const ReducedModel& reduced) const
  {
    const auto free = all_rows_but(reduced.K.rows(), held.front());
    return {reduced.K(free, free), reduced.M(free, free),
            loads(reduced.K.rows(), true)(free, Eigen::all)};
  }
  ResponseGoal goal(double tolerance) const
  {
    return {.Omega = end, .tolerance = tolerance, .loads = [=, this](const ReducedModel& reduced) {
              const Modal modal = of(reduced);
              const mbs_export::LoadedDofs forces{
                  .dofs = std::vector<int>(std::size_t(n_loads())),
                  .is_moment = std::vector<char>(std::size_t(n_loads()), 0),
                  .names = {},
                  .groups = {}};
              const mbs_export::ResponseSizes sizes = mbs_export::response_sizes(
                  mbs_export::reference_modes(modal.lambda.cwiseSqrt(), modal.B, forces),
                  {.error = tolerance, .up_to_Hz = end / (2.0 * std::numbers::pi)});
              return ResponseLoads{.F = loads(n_loads() + 1, true) * sizes.unit.asDiagonal(),
                                   .Omega = sizes.Omega,
                                   .size = sizes.size,
                                   .loss_factor = eta};
            }};
  }
};

/// The largest error of the responses of a model, relative to its size, as it is.
double true_error_of_body(const ReducedRandomBody& body)
{
  const Modal exact = body.exact(), reduced = body.of(body.model);
  double largest = 0.0;
  for (int i = 1; i <= 1000; ++i) {
    const double Omega = i / 1000.0 * body.end;
    for (const double eta : {0.5 * body.eta, body.eta}) {
      const MatrixXcd E = exact.responses(Omega, eta) - reduced.responses(Omega, eta);
      const VectorXd lengths = E.colwise().norm().transpose();
      largest = std::max(largest, lengths.cwiseQuotient(reduced.sizes(Omega, body.eta)).maxCoeff());
    }
  }
  return largest;
}

TEST(ResponseErrors, OfRandomBodiesAreBoundedAtAllFrequenciesWithDamping)
{
  constexpr double of_modes = 1e-8;  // what the eigen-solver left of them, at resonances
  int n_near = 0;
  constexpr unsigned n_bodies = 60;
  for (unsigned seed = 0; seed < n_bodies; ++seed) {
    const double tolerance = seed % 3 == 0 ? 10.0 : std::pow(10.0, -1.0 * (seed % 5));
    ReducedRandomBody body{.drawn = RandomBody(seed)};
    const double told = keep_responses(body.body, {body.Q, body.model}, body.held,
                                       body.modes.lambda_left_out, body.goal(tolerance))
                            .error;
    const double true_one = true_error_of_body(body);
    EXPECT_LE(true_one, told + of_modes) << "seed " << seed << ", tolerance " << tolerance;
    n_near += true_one > 0.2 * told ? 1 : 0;
  }
  EXPECT_GT(n_near, n_bodies / 2);  // a bound that tells something
}

TEST(ResponseErrors, NeedTheModesOfTheRange)
{
  LoadedChain loaded;
  ResponseGoal goal = goal_of(loaded, 1e-3);
  const auto up_to = [&](double factor) {
    goal.Omega = factor * std::sqrt(loaded.modes.lambda_left_out);
    return testing::refused_numbers([&] {
      keep_responses(loaded.body, {loaded.Q, loaded.model}, loaded.held,
                     loaded.modes.lambda_left_out, goal);
    });
  };
  for (const double factor : {1.1, 1.0 + 1e-8}) {  // told apart also at the edge
    const std::vector<std::string> numbers = up_to(factor);
    ASSERT_EQ(numbers.size(), 2u) << factor;
    EXPECT_GT(std::stod(numbers[0]), std::stod(numbers[1])) << factor;
  }
}

}  // namespace
}  // namespace chladni::reduce
