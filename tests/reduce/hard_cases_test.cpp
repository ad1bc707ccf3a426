// Structures on which a reduction may go wrong in silence.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "linear/dense/dense_solvers.hpp"
#include "reduce/error_estimates.hpp"
#include "reduce/partition.hpp"
#include "tests/linear/chain.hpp"

namespace chladni::reduce {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using linear::testing::Chain, linear::testing::empty, linear::testing::finish,
    linear::testing::master_set;

constexpr double pi = std::numbers::pi;

/// Bending beam of n elements of length 1 with EI = rho A = 1, free at both ends; DOFs w, phi of
/// each node in turn.
Chain free_beam(PetscInt n_elements)
{
  const PetscInt n = 2 * (n_elements + 1);
  Chain beam;
  for (petsc::Matrix* A : {&beam.K, &beam.M}) {
    petsc::check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n, n, 6, nullptr, 6,
                              nullptr, A->put()));
  }
  constexpr double K_e[4][4] = {{12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}};
  constexpr double M_e[4][4] = {
      {156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};
  const bool first_rank = petsc::rank(PETSC_COMM_WORLD) == 0;
  for (PetscInt e = 0; first_rank && e < n_elements; ++e) {
    for (PetscInt i = 0; i < 4; ++i) {
      for (PetscInt j = 0; j < 4; ++j) {
        petsc::check(MatSetValue(beam.K, 2 * e + i, 2 * e + j, K_e[i][j], ADD_VALUES));
        petsc::check(MatSetValue(beam.M, 2 * e + i, 2 * e + j, M_e[i][j] / 420.0, ADD_VALUES));
      }
    }
  }
  finish(beam.K);
  finish(beam.M);
  return beam;
}

/// Chain of masses m(i) and springs k(i) between i and i + 1; both ends are free.
Chain chain(PetscInt n, const std::function<double(PetscInt)>& k,
            const std::function<double(PetscInt)>& m)
{
  Chain made{.K = empty(n), .M = empty(n)};
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(made.K, &first, &last));
  for (PetscInt i = first; i < last; ++i) {
    const double before = i > 0 ? k(i - 1) : 0.0, behind = i + 1 < n ? k(i) : 0.0;
    petsc::check(MatSetValue(made.K, i, i, before + behind, INSERT_VALUES));
    if (i > 0) petsc::check(MatSetValue(made.K, i, i - 1, -before, INSERT_VALUES));
    if (i + 1 < n) petsc::check(MatSetValue(made.K, i, i + 1, -behind, INSERT_VALUES));
    petsc::check(MatSetValue(made.M, i, i, m(i), INSERT_VALUES));
  }
  finish(made.K);
  finish(made.M);
  return made;
}

struct Reduced {
  ReducedModel model;
  std::vector<double> lambda;  ///< of the free reduced body, ascending
  std::vector<double> eta2;    ///< of those that are no rigid motion
};

/// Reduced to `masters` with n_modes; free.
Reduced reduce(const Chain& body, const std::vector<PetscInt>& masters, int n_modes, int n_rigid)
{
  const DofPartition rows = partition(body.K, master_set(body.K, masters));
  const Blocks K = split(body.K, rows), M = split(body.M, rows);
  const linear::Factorization K_ss = linear::factorize(K.ss);
  const CraigBamptonBasis Q_CB{.Psi = constraint_modes(K_ss, K),
                               .modes = fixed_interface_modes(K_ss, M.ss, {.modes = n_modes})};
  Reduced reduced{.model = project(Q_CB, K, M), .lambda = {}, .eta2 = {}};
  const Eigen::Index n = reduced.model.K.rows();
  // M x = mu (K + s M) x, s near the low eigenvalues, keeps these accurate.
  const double s = std::pow(reduced.model.omega[0], 2);
  const MatrixXd &K_r = reduced.model.K, &M_r = reduced.model.M;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(M_r, K_r + s * M_r);
  ReducedPairs pairs{.X = MatrixXd(n, n - n_rigid), .lambda = {}};
  for (Eigen::Index j = 0; j < n; ++j) {
    reduced.lambda.push_back(1.0 / eigen.eigenvalues()[n - 1 - j] - s);
    if (j < n_rigid) continue;
    const VectorXd x = eigen.eigenvectors().col(n - 1 - j);
    pairs.X.col(j - n_rigid) = x / std::sqrt(x.dot(M_r * x));
    pairs.lambda.push_back(reduced.lambda.back());
  }
  reduced.eta2 = error_estimates({K_ss, Q_CB, K, M}, pairs).eta2;
  return reduced;
}

/// What the reduction complains of; empty if of nothing.
std::string complaint(const Chain& body, const std::vector<PetscInt>& masters, int n_modes)
{
  try {
    reduce(body, masters, n_modes, 0);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(HardCase, OneNodeHoldsALongBeam)
{
  constexpr int n = 300;
  const Reduced reduced = reduce(free_beam(n), {0, 1}, 30, 2);
  const double scale = std::pow(n, 4);
  // K_ss is that of a cantilever of 300 elements: its condition, 1e11, times round-off.
  for (int j = 0; j < 2; ++j) EXPECT_NEAR(reduced.lambda[j], 0.0, 1e-9 * reduced.lambda[2]);
  const double beta_L[] = {4.730040744862704, 7.853204624095838, 10.995607838001671};
  for (int j = 0; j < 3; ++j) {
    const double exact = std::pow(beta_L[j], 4) / scale;
    EXPECT_NEAR(reduced.lambda[2 + j] / exact, 1.0, reduced.eta2[j] * 1.1 + 5e-5)
        << "mode " << j + 1;
    EXPECT_LT(reduced.eta2[j], 1e-3);
  }
}

TEST(HardCase, AMasterThatLetsTheBodyRotateIsRefused)
{
  // Round-off may leave the last pivot positive.
  for (const PetscInt n : {5, 20, 60, 300}) {
    EXPECT_NE(complaint(free_beam(n), {0}, 3).find("not positive definite"), std::string::npos)
        << n << " elements";
  }
}

TEST(HardCase, ABodyWithoutAMasterIsRefused)
{
  // Two chains; the second one has springs in which round-off may hide.
  const auto springs = [](PetscInt i) { return i == 19 ? 0.0 : 1.0 + 0.1 * std::sin(7.0 * i); };
  const Chain two = chain(40, springs, [](PetscInt) { return 1.0; });
  const std::string refusal = complaint(two, {0}, 3);
  EXPECT_NE(refusal.find("not positive definite"), std::string::npos) << refusal;
  EXPECT_EQ(complaint(two, {0, 30}, 3), "");
}

TEST(HardCase, ANodeWithoutMassFollowsItsNeighbours)
{
  // Without the mass at 10, its springs are one of half the stiffness.
  const auto unit = [](PetscInt) { return 1.0; };
  const Chain with_it = chain(21, unit, [](PetscInt i) { return i == 10 ? 0.0 : 1.0; });
  const Chain without = chain(
      20, [](PetscInt i) { return i == 9 ? 0.5 : 1.0; }, unit);
  const Reduced a = reduce(with_it, {0, 20}, 18, 1), b = reduce(without, {0, 19}, 18, 1);
  ASSERT_EQ(a.lambda.size(), b.lambda.size());
  for (std::size_t i = 1; i < a.lambda.size(); ++i)
    EXPECT_NEAR(a.lambda[i] / b.lambda[i], 1.0, 1e-10) << "mode " << i;
  EXPECT_NE(complaint(with_it, {0, 20}, 19).find("M_ss has no more"), std::string::npos);
}

TEST(HardCase, AStiffnessContrastOf1e8LeavesTheLowModesTheirDigits)
{
  // Pairs of masses that a hard spring joins move as one of twice the mass: free chain of n / 2.
  constexpr PetscInt n = 80;
  const Chain hard = chain(
      n, [](PetscInt i) { return i % 2 == 0 ? 1e8 : 1.0; }, [](PetscInt) { return 1.0; });
  const Reduced reduced = reduce(hard, {0, n - 1}, 20, 1);
  for (int k = 1; k < 6; ++k) {
    const double exact = 0.5 * 4.0 * std::pow(std::sin(k * pi / n), 2);
    // A hard spring in series with a soft one takes 1e-8 of its stiffness; round-off is 1e8 eps.
    EXPECT_NEAR(reduced.lambda[k] / exact - 1.0, 0.0, 1.1 * reduced.eta2[k - 1] + 1e-7)
        << "mode " << k;
  }
}

TEST(HardCase, AlmostAllDofsAreMasters)
{
  const auto unit = [](PetscInt) { return 1.0; };
  std::vector<PetscInt> masters;
  for (PetscInt i = 0; i < 1200; ++i)
    if (i % 6 != 3) masters.push_back(i);
  ASSERT_EQ(masters.size(), 1000u);
  const Chain body = chain(1200, unit, unit);
  const DofPartition rows = partition(body.K, master_set(body.K, masters));
  const Blocks K = split(body.K, rows), M = split(body.M, rows);
  const linear::Factorization K_ss = linear::factorize(K.ss);
  const ReducedModel model = project(
      {.Psi = constraint_modes(K_ss, K), .modes = fixed_interface_modes(K_ss, M.ss, {.modes = 5})},
      K, M);
  EXPECT_EQ(model.n_masters, 1000);
  for (PetscInt i = 0; i < 1000; i += 111) {  // rigid translation meets no force
    double force = 0.0, mass = 0.0;
    for (PetscInt j = 0; j < 1000; ++j) force += model.K(i, j);
    for (PetscInt j = 0; j < 1000; ++j) mass += model.M(i, j);
    EXPECT_NEAR(force, 0.0, 1e-13);
    EXPECT_GT(mass, 0.9);
  }
}

}  // namespace
}  // namespace chladni::reduce
