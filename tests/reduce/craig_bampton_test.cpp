#include "reduce/craig_bampton.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "pencils.hpp"
#include "reduce/partition.hpp"
#include "reduce/static_condensation.hpp"
#include "tests/linear/chain.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

using linear::testing::free_chain;
using linear::testing::master_set;

constexpr PetscInt n_of_chain = 40;  // masses
constexpr double round_off = 1e-12;

/// The chain reduced to its two ends.
struct Reduction {
  linear::testing::Chain chain = free_chain(n_of_chain);
  DofPartition dofs = partition(chain.K, master_set(chain.K, {0, n_of_chain - 1}));
  Blocks K = split(chain.K, dofs);
  Blocks M = split(chain.M, dofs);
  linear::Factorization K_ss = linear::factorize(K.ss);
};

CraigBamptonBasis craig_bampton(const Reduction& r, int n_modes)
{
  return {.Psi = constraint_modes(r.K_ss, r.K),
          .modes = fixed_interface_modes(r.K_ss, r.M.ss, {.modes = n_modes, .cutoff_Hz = {}})};
}

/// Frequency of mode k = 1, 2, ... of m = n - 2 masses between fixed ends.
double fixed_chain_frequency(int k)
{
  return 2.0 * std::sin(0.5 * k * std::numbers::pi / (n_of_chain - 1));
}

std::vector<PetscInt> all_dofs()
{
  std::vector<PetscInt> dofs(n_of_chain);
  std::iota(dofs.begin(), dofs.end(), 0);
  return dofs;
}

TEST(ConstraintModes, InterpolateLinearlyBetweenTheEnds)
{
  const Reduction r;
  const Eigen::MatrixXd Q =
      basis_rows({.Psi = constraint_modes(r.K_ss, r.K), .modes = {}}, r.dofs, all_dofs());
  for (PetscInt i = 0; i < n_of_chain; ++i) {
    EXPECT_NEAR(Q(i, 1), double(i) / (n_of_chain - 1), round_off);
    EXPECT_NEAR(Q(i, 0) + Q(i, 1), 1.0, round_off);  // rigid translation
  }
}

/// Two free chains of n masses that lie into each other, and their translations as a sum and as a
/// difference.
struct TwoChains {
  petsc::Matrix K = linear::testing::empty(2 * n_of_chain), R;

  TwoChains()
  {
    petsc::check(MatCreateDense(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, 2 * n_of_chain, 2,
                                nullptr, R.put()));
    PetscInt first = 0, last = 0;
    petsc::check(MatGetOwnershipRange(K, &first, &last));
    for (PetscInt i = first; i < last; ++i) {
      petsc::check(MatSetValue(K, i, i, (i > 1) + (i + 2 < 2 * n_of_chain), INSERT_VALUES));
      if (i > 1) petsc::check(MatSetValue(K, i, i - 2, -1.0, INSERT_VALUES));
      if (i + 2 < 2 * n_of_chain) petsc::check(MatSetValue(K, i, i + 2, -1.0, INSERT_VALUES));
      petsc::check(MatSetValue(R, i, 0, 1.0, INSERT_VALUES));
      petsc::check(MatSetValue(R, i, 1, i % 2 == 0 ? 1.0 : -1.0, INSERT_VALUES));
    }
    linear::testing::finish(K);
    linear::testing::finish(R);
  }
};

TEST(RigidConstraintModes, CarryMotionsExactlyAndKeepTheZerosOfWhatIsNotCoupled)
{
  const TwoChains chains;
  const DofPartition dofs =
      partition(chains.K, master_set(chains.K, {0, 1, 2 * n_of_chain - 2, 2 * n_of_chain - 1}));
  const Blocks K = split(chains.K, dofs);
  petsc::Matrix Psi = constraint_modes(linear::factorize(K.ss), K);
  petsc::check(MatScale(Psi, 1.0 + 1e-9));  // an error that the correction has to take out
  const CraigBamptonBasis Q{
      .Psi = with_rigid_motions(std::move(Psi), {.R = chains.R, .dofs = dofs, .K = K}),
      .modes = {}};
  std::vector<PetscInt> all(2 * n_of_chain);
  std::iota(all.begin(), all.end(), 0);
  const Eigen::MatrixXd rows = basis_rows(Q, dofs, all);
  for (PetscInt i = 0; i < 2 * n_of_chain; ++i) {
    const PetscInt own = i % 2, other = 1 - own;  // columns 0 and 2 belong to the first chain
    EXPECT_NEAR(rows(i, own) + rows(i, own + 2), 1.0, 1e-15) << i;
    EXPECT_EQ(rows(i, other), 0.0) << i;
    EXPECT_EQ(rows(i, other + 2), 0.0) << i;
  }
}

TEST(FixedInterfaceModes, HaveTheFrequenciesOfTheChainBetweenFixedEnds)
{
  const Reduction r;
  const auto modes = fixed_interface_modes(r.K_ss, r.M.ss, {.modes = 7, .cutoff_Hz = {}});
  ASSERT_EQ(modes.omega.size(), 7u);
  for (int k = 1; k <= 7; ++k)
    EXPECT_NEAR(modes.omega[k - 1], fixed_chain_frequency(k), 1e-10);  // tolerance of the solver
}

TEST(FixedInterfaceModes, AreTheSameByKrylovSchur)
{
  const Reduction r;
  const auto blocks = fixed_interface_modes(r.K_ss, r.M.ss, {.modes = 7, .cutoff_Hz = {}});
  const linear::Factorization K_ss =
      linear::factorize(r.K.ss, {.lanczos = {.solver = linear::ModeSolver::krylov_schur}});
  const auto single = fixed_interface_modes(K_ss, r.M.ss, {.modes = 7, .cutoff_Hz = {}});
  ASSERT_EQ(single.omega.size(), 7u);
  for (int k = 0; k < 7; ++k)
    EXPECT_NEAR(single.omega[k], blocks.omega[k], 1e-11);  // both to round-off of cond(K) eps
}

TEST(FixedInterfaceModes, AreRefusedBelowACutoffThatIsToldApartFromTheFirst)
{
  const Reduction r;
  const auto below = [&](double factor) {
    const double cutoff_Hz = factor * fixed_chain_frequency(1) / (2.0 * std::numbers::pi);
    return testing::refused_numbers(
        [&] { fixed_interface_modes(r.K_ss, r.M.ss, {.cutoff_Hz = cutoff_Hz}); });
  };
  const std::vector<std::string> numbers = below(1.0 - 1e-8);
  ASSERT_EQ(numbers.size(), 2u);
  EXPECT_LT(std::stod(numbers[0]), std::stod(numbers[1]));
  EXPECT_TRUE(below(1.0 + 1e-8).empty());
}

TEST(FixedInterfaceModes, BelowACutoffAreAllThereAre)
{
  const Reduction r;
  const double cutoff = 0.5 * (fixed_chain_frequency(12) + fixed_chain_frequency(13));
  const auto modes = fixed_interface_modes(
      r.K_ss, r.M.ss, {.modes = {}, .cutoff_Hz = cutoff / (2.0 * std::numbers::pi)});
  EXPECT_EQ(modes.omega.size(), 12u);
}

TEST(FixedInterfaceModes, AreOrthonormalInTheMass)
{
  const Reduction r;
  const auto modes = fixed_interface_modes(r.K_ss, r.M.ss, {.modes = 9, .cutoff_Hz = {}});
  const Eigen::MatrixXd I = linear::inner_product(modes.Phi, modes.Phi);  // M_ss = I
  for (PetscInt i = 0; i < I.rows(); ++i)
    for (PetscInt j = 0; j < I.cols(); ++j) EXPECT_NEAR(I(i, j), i == j ? 1.0 : 0.0, round_off);
}

TEST(FixedInterfaceModes, RefuseMoreModesThanExist)
{
  const Reduction r;
  EXPECT_THROW(fixed_interface_modes(r.K_ss, r.M.ss, {.modes = n_of_chain, .cutoff_Hz = {}}),
               Error);
}

TEST(FixedInterfaceModes, KeepTheTwoPartnersOfADoubleModeTogether)
{
  // Two equal chains that share the masters of a third between them: masters hold both ends of
  // each.
  const linear::testing::Chain chain = free_chain(2 * n_of_chain - 1);
  const DofPartition dofs =
      partition(chain.K, master_set(chain.K, {0, n_of_chain - 1, 2 * n_of_chain - 2}));
  const Blocks K = split(chain.K, dofs);
  const Blocks M = split(chain.M, dofs);
  const auto modes =
      fixed_interface_modes(linear::factorize(K.ss), M.ss, {.modes = 3, .cutoff_Hz = {}});
  EXPECT_EQ(modes.omega.size(), 4u);  // the cut through the second pair moves
}

TEST(FixedInterfaceModes, KeepNeighboursTogetherWhereTheCutoffLiesBetweenThem)
{
  // Two chains that share a master, the second one stiffer by 1e-4: each frequency of it lies 5e-5
  // above that of the first.
  constexpr double stiffer = 1.0 + 1e-4;
  const auto spring = [](PetscInt i) {  // from mass i to i + 1
    return i < 0 || i >= 2 * n_of_chain - 2 ? 0.0 : (i < n_of_chain - 1 ? 1.0 : stiffer);
  };
  const petsc::Matrix K_all = linear::testing::matrix(2 * n_of_chain - 1, 3, [&](PetscInt i) {
    linear::testing::Row row{{i, spring(i - 1) + spring(i)}};
    if (i > 0) row.emplace_back(i - 1, -spring(i - 1));
    if (i < 2 * n_of_chain - 2) row.emplace_back(i + 1, -spring(i));
    return row;
  });
  const petsc::Matrix M_all =
      linear::testing::diagonal(2 * n_of_chain - 1, [](PetscInt) { return 1.0; });
  const DofPartition dofs =
      partition(K_all, master_set(K_all, {0, n_of_chain - 1, 2 * n_of_chain - 2}));
  const Blocks K = split(K_all, dofs), M = split(M_all, dofs);
  const linear::Factorization K_ss = linear::factorize(K.ss);
  for (const int k : {1, 3, 8}) {
    const double between = fixed_chain_frequency(k) * 0.5 * (1.0 + std::sqrt(stiffer));
    const auto below =
        fixed_interface_modes(K_ss, M.ss, {.cutoff_Hz = between / (2.0 * std::numbers::pi)});
    ASSERT_EQ(below.omega.size(), std::size_t(2 * k));
    EXPECT_NEAR(below.omega.back(), fixed_chain_frequency(k) * std::sqrt(stiffer), 1e-10);
    EXPECT_EQ(fixed_interface_modes(K_ss, M.ss, {.modes = 2 * k - 1}).omega.size(),
              std::size_t(2 * k));
  }
}

/// Adds `share` of one column to another.
void add_column(Mat columns, PetscInt to, PetscInt from, double share)
{
  Vec source = nullptr, target = nullptr;
  petsc::Vector copy;
  petsc::check(MatDenseGetColumnVecRead(columns, from, &source));
  petsc::check(VecDuplicate(source, copy.put()));
  petsc::check(VecCopy(source, copy));
  petsc::check(MatDenseRestoreColumnVecRead(columns, from, &source));
  petsc::check(MatDenseGetColumnVec(columns, to, &target));
  petsc::check(VecAXPY(target, share, copy));
  petsc::check(MatDenseRestoreColumnVec(columns, to, &target));
}

TEST(LargestResidual, IsThatOfTheOneModeThatIsSpoiledWhicheverItIs)
{
  const Reduction r;
  constexpr int n_modes = 7;
  constexpr double c = 1e-3;
  for (const int spoiled : {0, 3, n_modes - 1}) {
    const auto modes = fixed_interface_modes(r.K_ss, r.M.ss, {.modes = n_modes});
    EXPECT_LT(largest_residual(modes, r.K.ss, r.M.ss), 1e-9);
    const int other = spoiled == 2 ? 1 : 2;
    add_column(modes.Phi, spoiled, other, c);
    // (K - lambda_i M) (phi_i + c phi_j) = c (lambda_j - lambda_i) M phi_j, orthonormal in M = I
    const double lambda = std::pow(modes.omega[std::size_t(spoiled)], 2),
                 lambda_other = std::pow(modes.omega[std::size_t(other)], 2);
    EXPECT_NEAR(largest_residual(modes, r.K.ss, r.M.ss),
                c * std::abs(lambda_other - lambda) / (lambda * std::sqrt(1.0 + c * c)), 1e-8)
        << spoiled;
  }
}

/// The entries with nine digits, as files of some programs have them.
petsc::Matrix with_nine_digits(const Eigen::MatrixXd& A)
{
  return linear::testing::matrix(PetscInt(A.rows()), PetscInt(A.cols()), [&](PetscInt i) {
    linear::testing::Row row;
    for (PetscInt j = 0; j < A.cols(); ++j)
      if (A(i, j) != 0.0) row.emplace_back(j, std::stod(fmt::format("{:.8e}", A(i, j))));
    return row;
  });
}

/// A chain, on the ground or free, and two rows without mass that one bar ties to its mass 5:
/// across the bar they move with neither stiffness nor mass.
linear::testing::Chain chain_with_massless_rows(double ground, double angle)
{
  constexpr PetscInt n_masses = 12, x = n_masses, y = n_masses + 1;
  std::vector<testing::ElementPencil> elements;
  for (PetscInt i = 0; i < n_masses; ++i) {
    const PetscInt next = (i + 1) % n_masses;
    Eigen::MatrixXd spring(2, 2), mass = Eigen::MatrixXd::Zero(2, 2);
    const double k = next == 0 ? 0.0 : 1.0 + i;
    spring << k, -k, -k, k;
    mass(0, 0) = 2.0;
    elements.push_back({.dofs = {i, next}, .K = spring, .M = mass});
  }
  const Eigen::Vector3d bar(std::cos(angle), std::sin(angle), -1.0);
  elements.push_back({.dofs = {x, y, 5}, .K = bar * bar.transpose(), .M = Eigen::Matrix3d::Zero()});
  Eigen::MatrixXd spring = Eigen::MatrixXd::Constant(1, 1, ground);
  elements.push_back({.dofs = {0}, .K = spring, .M = Eigen::MatrixXd::Zero(1, 1)});
  return testing::assemble(n_masses + 2, elements);
}

TEST(GuyanStiffness, RefusesAMotionWithoutMassWhicheverOfItsRowsAreMasters)
{
  struct Case {
    double ground;
    std::vector<PetscInt> masters;
  };
  // In the first two K_G vanishes altogether; in the last ones the mass of other rows is in M_G.
  for (const Case& c : {Case{0.0, {0, 13}},
                        {1.0, {13}},
                        {0.0, {5, 13}},
                        {0.0, {0, 12, 13}},
                        {1.0, {3, 12, 13}},
                        {1.0, {5, 12, 13}}}) {
    for (double angle = 0.3; angle < 6.3; angle += 0.3) {
      const linear::testing::Chain pencil = chain_with_massless_rows(c.ground, angle);
      const DofPartition dofs = partition(pencil.K, master_set(pencil.K, c.masters));
      const Blocks K = split(pencil.K, dofs), M = split(pencil.M, dofs);
      const petsc::Matrix Psi = constraint_modes(linear::factorize(K.ss), K);
      EXPECT_THROW(guyan_stiffness(Psi, K, M), Error)
          << c.masters.size() << " masters, angle " << angle;
    }
  }
}

TEST(GuyanStiffness, TakesALightMotionForWhatItIs)
{
  linear::testing::Chain pencil = chain_with_massless_rows(0.0, 0.7);
  for (const PetscInt row : {12, 13})
    if (petsc::rank(PETSC_COMM_WORLD) == 0)
      petsc::check(MatSetValue(pencil.M, row, row, 1e-9, ADD_VALUES));
  linear::testing::finish(pencil.M);
  const DofPartition dofs = partition(pencil.K, master_set(pencil.K, {0, 12, 13}));
  const Blocks K = split(pencil.K, dofs), M = split(pencil.M, dofs);
  const petsc::Matrix Psi = constraint_modes(linear::factorize(K.ss), K);
  EXPECT_EQ(guyan_stiffness(Psi, K, M).R.cols(), 2);
}

TEST(GuyanStiffness, HasSixRigidMotionsOfABlockWhoseFileHasNineDigits)
{
  const testing::Body block = testing::solid_block({3, 2, 2}, {0.3, 0.1, 0.12});
  const petsc::Matrix K_all = with_nine_digits(testing::whole(block.pencil.K));
  std::vector<PetscInt> masters;
  for (const PetscInt node : {0, 3, 8, 35})
    for (PetscInt component = 0; component < 3; ++component)
      masters.push_back(3 * node + component);
  const DofPartition dofs = partition(K_all, master_set(K_all, masters));
  const Blocks K = split(K_all, dofs), M = split(block.pencil.M, dofs);
  const petsc::Matrix Psi = constraint_modes(linear::factorize(K.ss), K);
  const GuyanStiffness guyan = guyan_stiffness(Psi, K, M);
  ASSERT_EQ(guyan.R.cols(), 6);
  EXPECT_LT((guyan.K * guyan.R).norm(), 1e-12 * guyan.K.norm() * guyan.R.norm());
  // They are the rigid motions of the masters, as far as nine digits go.
  Eigen::MatrixXd rigid = Eigen::MatrixXd::Zero(12, 6);
  for (PetscInt i = 0; i < 4; ++i) {
    const auto [x, y, z] = block.positions[std::size_t(masters[std::size_t(3 * i)] / 3)];
    rigid.block<3, 3>(3 * i, 0).setIdentity();
    rigid.block<3, 3>(3 * i, 3) << 0.0, z, -y, -z, 0.0, x, y, -x, 0.0;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rigid);
  const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(12, 6);
  EXPECT_LT((guyan.R - Q * (Q.transpose() * guyan.R)).norm(), 1e-7 * guyan.R.norm());
}

TEST(Factorization, RefusesAPartThatNoMasterHolds)
{
  const linear::testing::Chain chain = free_chain(12);
  EXPECT_THROW(linear::factorize(chain.K), Error);
}

TEST(Project, GivesTheGuyanMatricesOfTheChain)
{
  const Reduction r;
  const ReducedModel guyan = project({.Psi = constraint_modes(r.K_ss, r.K), .modes = {}}, r.K, r.M);
  const double k = 1.0 / (n_of_chain - 1);  // springs in series
  EXPECT_NEAR(guyan.K(0, 0), k, round_off);
  EXPECT_NEAR(guyan.K(0, 1), -k, round_off);
  const double total = guyan.M(0, 0) + 2.0 * guyan.M(0, 1) + guyan.M(1, 1);
  EXPECT_NEAR(total, n_of_chain, 100 * round_off);  // all of the mass moves with the two ends
}

TEST(Project, KeepsTheBlocksThatMultiplicationWouldGive)
{
  const Reduction r;
  const CraigBamptonBasis Q_CB = craig_bampton(r, 6);
  const ReducedModel reduced = project(Q_CB, r.K, r.M);
  const Eigen::MatrixXd Q = basis_rows(Q_CB, r.dofs, all_dofs());
  const auto product = [&](Mat A, PetscInt i, PetscInt j) {
    const Eigen::MatrixXd full = linear::replicate(A);
    double sum = 0.0;
    for (PetscInt a = 0; a < n_of_chain; ++a)
      for (PetscInt b = 0; b < n_of_chain; ++b) sum += Q(a, i) * full(a, b) * Q(b, j);
    return sum;
  };
  for (PetscInt i = 0; i < reduced.K.rows(); ++i) {
    for (PetscInt j = 0; j < reduced.K.cols(); ++j) {
      EXPECT_NEAR(reduced.K(i, j), product(r.chain.K, i, j), 1e-10);  // tolerance of the modes
      EXPECT_NEAR(reduced.M(i, j), product(r.chain.M, i, j), 1e-10);
    }
  }
}

/// Dampers between some masses and to the ground, not proportional to K or M; unsymmetric by a
/// gyroscopic pair.
petsc::Matrix dampers()
{
  petsc::Matrix C = linear::testing::empty(n_of_chain);
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(C, &first, &last));
  const auto set = [&](PetscInt i, PetscInt j, double value) {
    if (i >= first && i < last) petsc::check(MatSetValue(C, i, j, value, INSERT_VALUES));
  };
  for (PetscInt i = 0; i + 1 < n_of_chain; i += 3) {  // each pair apart from the next
    const double c = 0.1 + 0.01 * i;
    set(i, i, c);
    set(i + 1, i + 1, c);
    set(i, i + 1, -c);
    set(i + 1, i, -c);
  }
  set(20, 20, 0.7);
  set(5, 6, 0.4);
  set(6, 5, -0.4);
  linear::testing::finish(C);
  return C;
}

TEST(ProjectDamping, IsTheTripleProductWithTheBasis)
{
  const Reduction r;
  const CraigBamptonBasis Q_CB = craig_bampton(r, 6);
  const petsc::Matrix C = dampers();
  const Eigen::MatrixXd C_r = project_form(Q_CB, split(C, r.dofs));
  const Eigen::MatrixXd Q = basis_rows(Q_CB, r.dofs, all_dofs());
  const Eigen::MatrixXd C_all = linear::replicate(C);
  ASSERT_EQ(C_r.rows(), 8);
  for (PetscInt a = 0; a < 8; ++a) {
    for (PetscInt b = 0; b < 8; ++b) {
      double exact = 0.0;
      for (PetscInt i = 0; i < n_of_chain; ++i)
        for (PetscInt j = 0; j < n_of_chain; ++j) exact += Q(i, a) * C_all(i, j) * Q(j, b);
      EXPECT_NEAR(C_r(a, b), exact, round_off);
    }
  }
  EXPECT_GT(std::abs(C_r(2, 3) - C_r(3, 2)), 1e-4);  // the gyroscopic part is there
}

TEST(ProjectForms, AreTheTripleProductsWithTheBasis)
{
  const Reduction r;
  const CraigBamptonBasis Q_CB = craig_bampton(r, 6);
  const petsc::Matrix C = dampers();
  const std::vector<linear::SparseForm> forms{
      {.A = r.chain.K, .symmetry = linear::FormSymmetry::symmetric},
      {.A = C, .symmetry = linear::FormSymmetry::none}};
  const std::vector<Eigen::MatrixXd> projected = project_forms(Q_CB, r.dofs, forms);
  const Eigen::MatrixXd Q = basis_rows(Q_CB, r.dofs, all_dofs());
  ASSERT_EQ(projected.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LT((projected[i] - Q.transpose() * linear::replicate(forms[i].A) * Q).norm(), round_off);
}

}  // namespace
}  // namespace chladni::reduce
