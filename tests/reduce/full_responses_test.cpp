#include "linear/dense/dense_solvers.hpp"
#include "reduce/harmonic_response.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "reduce/craig_bampton.hpp"
#include "reduce/partition.hpp"
#include "tests/linear/chain.hpp"

namespace chladni::reduce {
namespace {

using Eigen::MatrixXd;
using linear::testing::free_chain;
using linear::testing::master_set;

constexpr PetscInt n_of_full_chain = 40;  // masses
constexpr double Omega_0 = 0.31;

/// The chain reduced to its two ends.
struct FullReduction {
  linear::testing::Chain chain = free_chain(n_of_full_chain);
  DofPartition dofs = partition(chain.K, master_set(chain.K, {0, n_of_full_chain - 1}));
  Blocks K = split(chain.K, dofs);
  Blocks M = split(chain.M, dofs);
  linear::Factorization K_ss = linear::factorize(K.ss);

  CraigBamptonBasis basis(int n_modes) const
  {
    return {.Psi = constraint_modes(K_ss, K),
            .modes = fixed_interface_modes(K_ss, M.ss, {.modes = n_modes, .cutoff_Hz = {}})};
  }
};

/// The displacement of every mass when the reduced chain is loaded at its first end.
MatrixXd response(const CraigBamptonBasis& Q_CB, const FullReduction& r, double Omega)
{
  const ReducedModel reduced = project(Q_CB, r.K, r.M);
  const MatrixXd D = reduced.K - Omega * Omega * reduced.M;
  std::vector<PetscInt> all(n_of_full_chain);
  std::iota(all.begin(), all.end(), 0);
  const MatrixXd Q = basis_rows(Q_CB, r.dofs, all);
  return Q * D.partialPivLu().solve(MatrixXd(MatrixXd::Identity(D.rows(), 1)));
}

TEST(FullResponses, SolveTheWholeChain)
{
  const FullReduction r;
  const petsc::Matrix V = full_responses(r.chain.K, r.chain.M, Omega_0, {0, n_of_full_chain - 1});
  const MatrixXd v = linear::replicate(V);
  // u_j of the free chain: (2 - Omega^2) u_j = u_(j-1) + u_(j+1) but for the ends.
  for (PetscInt j = 1; j + 1 < n_of_full_chain; ++j)
    EXPECT_NEAR((2.0 - Omega_0 * Omega_0) * v(j, 0), v(j - 1, 0) + v(j + 1, 0), 1e-12);
  EXPECT_NEAR((1.0 - Omega_0 * Omega_0) * v(0, 0) - v(1, 0), 1.0, 1e-12);
  EXPECT_NEAR(v(n_of_full_chain - 1, 0), v(0, 1), 1e-12);  // reciprocity
}

TEST(Enrich, MakesTheReducedResponseExactAtItsFrequency)
{
  const FullReduction r;
  CraigBamptonBasis Q_CB = r.basis(3);
  const petsc::Matrix V = full_responses(r.chain.K, r.chain.M, Omega_0, {0});
  const MatrixXd exact = linear::replicate(V);
  const MatrixXd before = response(Q_CB, r, Omega_0);
  EXPECT_GT((before - exact).norm(), 1e-5 * exact.norm());  // three modes alone are not enough
  Enrichment enriched = enrich(Q_CB, r.dofs, {r.K.ss, r.M.ss}, V);
  EXPECT_EQ(enriched.n_added, 1);
  ASSERT_EQ(enriched.modes.omega.size(), 4u);
  Q_CB.modes = std::move(enriched.modes);
  EXPECT_LT((response(Q_CB, r, Omega_0) - exact).norm(), 1e-10 * exact.norm());
}

TEST(Enrich, KeepsWhatIsKnownOfFixedInterfaceModes)
{
  const FullReduction r;
  CraigBamptonBasis Q_CB = r.basis(3);
  const petsc::Matrix V = full_responses(r.chain.K, r.chain.M, Omega_0, {0, n_of_full_chain - 1});
  Q_CB.modes = enrich(Q_CB, r.dofs, {r.K.ss, r.M.ss}, V).modes;
  ASSERT_EQ(Q_CB.n_modes(), 5);
  // K_r and M_r in full, where `project` takes blocks for known.
  const MatrixXd K = project_form(Q_CB, r.K), M = project_form(Q_CB, r.M);
  const ReducedModel reduced = project(Q_CB, r.K, r.M);
  EXPECT_LT((K - reduced.K).norm(), 1e-11 * K.norm());
  EXPECT_LT((M - reduced.M).norm(), 1e-11 * M.norm());
}

TEST(Enrich, MakesTheResponseExactAtEachOfSeveralFrequencies)
{
  const FullReduction r;
  const std::vector<HarmonicLoads> loads{{.Omega_0 = Omega_0, .loaded = {0}},
                                         {.Omega_0 = 1.7 * Omega_0, .loaded = {0}}};
  CraigBamptonBasis Q_CB = r.basis(3);
  const petsc::Matrix V = full_responses(r.chain.K, r.chain.M, loads);
  Q_CB.modes = enrich(Q_CB, r.dofs, {r.K.ss, r.M.ss}, V).modes;
  ASSERT_EQ(Q_CB.n_modes(), 5);
  const MatrixXd exact = linear::replicate(V);
  for (Eigen::Index i = 0; i < 2; ++i) {
    const MatrixXd found = response(Q_CB, r, loads[std::size_t(i)].Omega_0);
    EXPECT_LT((found.col(0) - exact.col(i)).norm(), 1e-10 * exact.col(i).norm()) << i;
  }
}

TEST(Enrich, AddsNothingForWhatTheBasisHolds)
{
  const FullReduction r;
  CraigBamptonBasis Q_CB = r.basis(3);
  const petsc::Matrix V = full_responses(r.chain.K, r.chain.M, Omega_0, {0});
  Q_CB.modes = enrich(Q_CB, r.dofs, {r.K.ss, r.M.ss}, V).modes;
  const Enrichment again = enrich(Q_CB, r.dofs, {r.K.ss, r.M.ss}, V);
  EXPECT_EQ(again.n_added, 0);
  EXPECT_EQ(again.modes.omega.size(), 4u);
}

}  // namespace
}  // namespace chladni::reduce
