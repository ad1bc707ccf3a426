#include "reduce/harmonic_response.hpp"
#include "linear/dense/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "linear/kernels/dense_matrices.hpp"
#include "tests/linear/chain.hpp"

namespace chladni::reduce {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd;
using linear::testing::Chain;
using linear::testing::free_chain;
using Complex = std::complex<double>;

constexpr PetscInt n_of_loaded_chain = 40;  // masses
const std::vector<DofForm> loads{{.dofs = {0}, .weights = {1.0}},
                                 {.dofs = {7, 30}, .weights = {0.25, 0.75}}};
const std::vector<DofForm> outputs{{.dofs = {39}, .weights = {1.0}},
                                   {.dofs = {7, 30}, .weights = {0.25, 0.75}},
                                   {.dofs = {12, 13}, .weights = {1.0, -1.0}}};

/// A damper of strength 0.4 between mass 5 and mass 33, which no spring joins.
petsc::Matrix damper()
{
  petsc::Matrix C = linear::testing::empty(n_of_loaded_chain);
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(C, &first, &last));
  for (const auto& [i, j] : {std::pair{5, 33}, std::pair{33, 5}}) {
    if (i < first || i >= last) continue;
    petsc::check(MatSetValue(C, i, i, 0.4, INSERT_VALUES));
    petsc::check(MatSetValue(C, i, j, -0.4, INSERT_VALUES));
  }
  linear::testing::finish(C);
  return C;
}

MatrixXd columns_of(const std::vector<DofForm>& forms)
{
  MatrixXd F = MatrixXd::Zero(n_of_loaded_chain, std::ssize(forms));
  for (std::size_t j = 0; j < forms.size(); ++j)
    for (std::size_t k = 0; k < forms[j].dofs.size(); ++k)
      F(forms[j].dofs[k], Index(j)) += forms[j].weights[k];
  return F;
}

/// The same by dense complex matrices.
MatrixXcd dense_response(const HarmonicModel& model, double Omega, const std::vector<int>& held)
{
  const MatrixXd K = linear::replicate(model.K), M = linear::replicate(model.M);
  const MatrixXd C = model.C == nullptr ? MatrixXd::Zero(n_of_loaded_chain, n_of_loaded_chain)
                                        : linear::replicate(model.C);
  const Complex i(0.0, 1.0);
  MatrixXcd A = Complex(1.0, model.loss_factor) * K +
                i * Omega * (C + model.alpha * M + model.beta * K) - Complex(Omega * Omega) * M;
  for (const int dof : held) {
    A.row(dof).setZero();
    A.col(dof).setZero();
    A(dof, dof) = 1.0;
  }
  MatrixXcd F = columns_of(loads).cast<Complex>();
  for (const int dof : held) F.row(dof).setZero();
  return columns_of(outputs).transpose() * A.partialPivLu().solve(F);
}

double difference(const MatrixXcd& a, const MatrixXcd& b)
{
  return (a - b).norm() / b.norm();
}

TEST(HarmonicResponse, IsThatOfTheDampedChainByDenseMatrices)
{
  const Chain chain = free_chain(n_of_loaded_chain);
  const petsc::Matrix C = damper();
  const std::vector<int> held{0, 20};
  const HarmonicModel model{
      .K = chain.K, .M = chain.M, .C = C, .loss_factor = 0.03, .alpha = 0.02, .beta = 0.01};
  HarmonicResponse response(model, free_dofs(chain.K, held), loads, outputs);
  for (const double Omega : {0.0, 0.11, 0.93, 1.7})  // one factor's order for all
    EXPECT_LT(difference(response.at(Omega), dense_response(model, Omega, held)), 1e-11) << Omega;
}

TEST(HarmonicResponse, OfEachKindOfDampingAloneIsThatOfDenseMatrices)
{
  const Chain chain = free_chain(n_of_loaded_chain);
  const petsc::Matrix C = damper();
  const HarmonicModel all[] = {{.K = chain.K, .M = chain.M},
                               {.K = chain.K, .M = chain.M, .C = C},
                               {.K = chain.K, .M = chain.M, .loss_factor = 0.1},
                               {.K = chain.K, .M = chain.M, .alpha = 0.1},
                               {.K = chain.K, .M = chain.M, .beta = 0.1}};
  for (const HarmonicModel& model : all) {
    HarmonicResponse response(model, free_dofs(chain.K, {}), loads, outputs);
    EXPECT_LT(difference(response.at(0.31), dense_response(model, 0.31, {})), 1e-11);
  }
}

TEST(HarmonicResponse, OfAnUndampedChainHasNoBoundAtItsFrequencies)
{
  const Chain chain = free_chain(n_of_loaded_chain);
  const auto frequency = [](int k) {
    return 2.0 * std::sin(k * std::numbers::pi / (2.0 * n_of_loaded_chain));
  };
  HarmonicResponse response({.K = chain.K, .M = chain.M}, free_dofs(chain.K, {}), loads, outputs);
  EXPECT_NO_THROW(response.at(0.5 * (frequency(4) + frequency(5))));
  EXPECT_ANY_THROW(response.at(frequency(5)));
  EXPECT_NO_THROW(response.at(0.5 * (frequency(5) + frequency(6))));
}

}  // namespace
}  // namespace chladni::reduce
