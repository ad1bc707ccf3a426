#include "reduce/error_estimates.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "chain.hpp"

namespace chladni::reduce {
namespace {

using Eigen::MatrixXd;
using testing::free_chain;
using testing::master_set;

constexpr PetscInt n = 60;

/// A chain reduced to its ends with a few modes; its first mass is held.
struct HeldChain {
  explicit HeldChain(int n_modes)
      : Q_CB{.Psi = constraint_modes(K_ss, K),
             .modes = fixed_interface_modes(K_ss, M.ss, {.modes = n_modes, .cutoff_Hz = {}})}
  {}
  testing::Chain chain = free_chain(n);
  DofPartition dofs = partition(chain.K, master_set(chain.K, {0, n - 1}));
  Blocks K = split(chain.K, dofs);
  Blocks M = split(chain.M, dofs);
  Factorization K_ss = factorize(K.ss);
  CraigBamptonBasis Q_CB;

  /// All pairs of the reduced pencil without its first coordinate.
  ReducedPairs pairs() const
  {
    const ReducedModel model = project(Q_CB, K, M);
    const PetscInt n_r = model.K.n_rows;
    const auto held = [&](const SmallMatrix& A) {
      return MatrixXd(Eigen::Map<const MatrixXd>(A.values.data(), n_r, n_r)
                          .bottomRightCorner(n_r - 1, n_r - 1));
    };
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(held(model.K), held(model.M));
    ReducedPairs result{.X = {n_r, n_r - 1}, .lambda = {}};
    for (PetscInt j = 0; j < n_r - 1; ++j) {
      result.lambda.push_back(eigen.eigenvalues()[j]);
      for (PetscInt i = 1; i < n_r; ++i) result.X(i, j) = eigen.eigenvectors()(i - 1, j);
    }
    return result;
  }
};

/// lambda_k, k = 1, 2, ..., of m = n - 1 masses, one end held and the other free.
double exact(int k)
{
  return 4.0 * std::pow(std::sin((2 * k - 1) * std::numbers::pi / (2.0 * (2 * n - 1))), 2);
}

double true_error(const ReducedPairs& pairs, int k)
{
  return pairs.lambda[k] / exact(k + 1) - 1.0;
}

TEST(ErrorEstimates, MatchTheTrueErrorOfAHeldChain)
{
  constexpr int n_modes = 12;
  const HeldChain held(n_modes);
  const ReducedPairs pairs = held.pairs();
  const std::vector<double> eta2 = error_estimates(held.K_ss, held.Q_CB, held.M, pairs);
  // The error lies in the fixed-interface modes left out. One of frequency lambda_j contributes
  // 1 / (1 - lambda / lambda_j) of its share in eta^2, at most that of the first one left out.
  const double left_out =
      4.0 * std::pow(std::sin((n_modes + 1) * std::numbers::pi / (2.0 * (n - 1))), 2);
  for (int k = 1; k < 9; ++k) {
    const double effectivity = eta2[k] / true_error(pairs, k);
    EXPECT_GT(effectivity, 1.0 - pairs.lambda[k] / left_out - 1e-3) << "mode " << k + 1;
    EXPECT_LT(effectivity, 1.0 + 1e-3) << "mode " << k + 1;
  }
}

TEST(ErrorEstimates, EncloseAnEigenvalueOfTheFullChain)
{
  for (const int n_modes : {3, 8, 20}) {
    const HeldChain held(n_modes);
    const ReducedPairs pairs = held.pairs();
    const std::vector<double> eta2 = error_estimates(held.K_ss, held.Q_CB, held.M, pairs);
    for (std::size_t i = 0; i < eta2.size(); ++i) {
      double nearest = 1.0;
      for (int k = 1; k < n; ++k) {
        nearest = std::min(nearest, std::abs(pairs.lambda[i] / exact(k) - 1.0));
      }
      // Round-off of an exact pair: cond(K) eps.
      EXPECT_LE(nearest, std::sqrt(eta2[i]) + 1e-11) << n_modes << " modes, pair " << i + 1;
    }
  }
}

TEST(ErrorEstimates, FallWithTheNumberOfModes)
{
  const HeldChain few(4), many(16);
  EXPECT_GT(error_estimates(few.K_ss, few.Q_CB, few.M, few.pairs())[2],
            50.0 * error_estimates(many.K_ss, many.Q_CB, many.M, many.pairs())[2]);
}

}  // namespace
}  // namespace chladni::reduce
