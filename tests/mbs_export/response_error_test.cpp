#include "mbs_export/response_error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/rank_update.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using Complex = std::complex<double>;

constexpr double one_hertz = 2.0 * std::numbers::pi;  // rad/s

/// Nine modes, among them a pair, under two forces; the second mode does not feel them.
const VectorXd omega{{2.0, 3.0, 5.0, 5.0, 9.0, 12.0, 16.0, 20.0, 30.0}};
MatrixXd loaded_shapes()
{
  MatrixXd B(9, 2);
  for (Index k = 0; k < 9; ++k)
    B.row(k) << std::cos(1.0 + double(k)), std::sin(2.0 * double(k + 1));
  B.row(1).setZero();
  return B;
}

LoadedDofs two_forces()
{
  return {.dofs = {0, 1}, .is_moment = {0, 0}, .names = {}, .groups = {}};
}

ReferenceResponse reference(double up_to)
{
  return reference_response(omega, loaded_shapes(), two_forces(),
                            {.error = 1e-3, .up_to_Hz = up_to / one_hertz});
}

/// H - B^T Q (Q^T D Q)^-1 Q^T B of any basis Q.
MatrixXcd remainder_of(const ReferenceResponse& complete, const MatrixXd& Q, double Omega)
{
  const VectorXcd D = Complex(1.0, 0.02) * omega.array().square() - Omega * Omega;
  const MatrixXcd D_q = Q.transpose() * D.asDiagonal() * Q;
  const MatrixXcd Q_B = (Q.transpose() * complete.B).cast<Complex>();
  return complete.B.transpose() * D.cwiseInverse().asDiagonal() * complete.B -
         Q_B.transpose() * D_q.inverse() * Q_B;
}

MatrixXcd remainder_at(const TrialBasis& basis, Index g)
{
  const MatrixXcd& half = basis.remainder[std::size_t(g)];
  return linear::symmetric_product(half, MatrixXd::Identity(half.rows(), half.cols()));
}

/// Largest difference between the remainder that was updated and the one by definition.
double update_error(const ReferenceResponse& complete, const TrialBasis& basis, const MatrixXd& Q)
{
  double largest = 0.0;
  for (Index g = 0; g < complete.Omega.size(); ++g) {
    const MatrixXcd expected = remainder_of(complete, Q, complete.Omega[g]);
    largest = std::max(
        largest, (remainder_at(basis, g) - expected).norm() / complete.H[std::size_t(g)].norm());
  }
  return largest;
}

TEST(TrialBasis, LeavesTheRemainderOfTheGalerkinResponseAfterEachStep)
{
  const ReferenceResponse complete = reference(8.0);
  // Modes 1 and 5, and static and dynamic responses of all others, in an order that makes
  // interface modes depend on modes which come later.
  MatrixXd Q(9, 0);
  const auto extend = [&](const MatrixXd& columns) {
    Q.conservativeResize(Eigen::NoChange, Q.cols() + columns.cols());
    Q.rightCols(columns.cols()) = columns;
  };
  const auto response = [&](Index load, double Omega_0) {
    return VectorXd(complete.B.col(load).array() / (omega.array().square() - Omega_0 * Omega_0));
  };
  // Q is not orthonormal: round-off times its condition, about 1e5. A step left out shows as 1e-3.
  constexpr double round_off = 1e-9;
  TrialBasis basis = with_cluster(complete, rigid_basis(complete), {0, 1});
  extend(MatrixXd::Identity(9, 1));
  EXPECT_LT(update_error(complete, basis, Q), round_off);
  basis = with_interface(complete, basis, {Eigen::Vector2d(1.0, 0.0), 0.0});
  extend(response(0, 0.0));
  EXPECT_LT(update_error(complete, basis, Q), round_off);
  basis = with_cluster(complete, basis, {4, 5});
  extend(VectorXd::Unit(9, 4));
  EXPECT_LT(update_error(complete, basis, Q), round_off);
  basis = with_interface(complete, basis, {MatrixXd::Identity(2, 2), 7.0});
  extend(response(0, 7.0));
  extend(response(1, 7.0));
  EXPECT_LT(update_error(complete, basis, Q), round_off);
  basis = with_cluster(complete, basis, {2, 4});
  extend(MatrixXd::Identity(9, 9).middleCols(2, 2));
  EXPECT_LT(update_error(complete, basis, Q), round_off);
  EXPECT_EQ(basis.n_kept(), 4);
  EXPECT_EQ(basis.n_modes(), 7);
}

TEST(TrialBasis, TakesNoInterfaceModeTwice)
{
  const ReferenceResponse complete = reference(8.0);
  const InterfaceChoice choice{Eigen::Vector2d(1.0, 0.0), 6.0};
  const TrialBasis once = with_interface(complete, rigid_basis(complete), choice);
  EXPECT_EQ(once.n_modes(), 1);
  EXPECT_EQ(with_interface(complete, once, choice).n_modes(), 1);
}

TEST(TrialBasis, MissesWhatItDoesNotHold)
{
  const ReferenceResponse complete = reference(8.0);
  TrialBasis basis = with_cluster(complete, rigid_basis(complete), {0, 1});
  basis = with_interface(complete, basis, {Eigen::Vector2d(0.0, 1.0), 1.0});
  for (Index g = 0; g < complete.Omega.size(); ++g)
    for (Index j = 0; j < 2; ++j) {
      const VectorXcd missing = complete.B.transpose() * missing_response(complete, basis, j, g);
      EXPECT_LT((missing - remainder_at(basis, g).col(j)).norm(),
                1e-11 * complete.H[std::size_t(g)].norm());
    }
}

TEST(ReferenceResponse, LooksAtTheResonancesThatAreExcited)
{
  const ReferenceResponse complete = reference(8.0);
  EXPECT_EQ(complete.resonances, (std::vector<int>{0, 2}));  // clusters: 2; 3; 5, 5; 9; ...
  const auto has = [&](double Omega) {
    return (complete.Omega.array() - Omega).abs().minCoeff() < 1e-12;
  };
  for (const double Omega : {0.0, 0.99 * 2.0, 2.0, 1.01 * 2.0, 5.0, 8.0}) EXPECT_TRUE(has(Omega));
  EXPECT_FALSE(has(3.0));
  EXPECT_EQ(complete.Omega.maxCoeff(), complete.Omega[complete.Omega.size() - 1]);
}

TEST(ReferenceResponse, IsDampedByOnePerCentOfTheCriticalDamping)
{
  const VectorXd one{{4.0}};
  const ReferenceResponse complete = reference_response(
      one, MatrixXd::Ones(1, 1), {.dofs = {0}, .is_moment = {0}, .names = {}, .groups = {}},
      {.error = 1e-3, .up_to_Hz = 4.0 / one_hertz});
  // At resonance the response is the static one over 2 zeta.
  const double static_response = std::abs(complete.H.front()(0, 0));
  EXPECT_NEAR(std::abs(complete.H.back()(0, 0)) / static_response, 50.0, 0.02);  // |1 + 0.02 i|
}

TEST(ReferenceResponse, DoesNotDependOnTheUnitOfLength)
{
  // In millimetres displacements grow by 1000 and rotations do not.
  LoadedDofs loads = two_forces();
  loads.is_moment[1] = 1;
  MatrixXd B = loaded_shapes();
  const Tolerance tolerance{.error = 1e-3, .up_to_Hz = 8.0 / one_hertz};
  const ReferenceResponse metres = reference_response(omega, B, loads, tolerance);
  B.col(0) *= 1000.0;
  const ReferenceResponse millimetres = reference_response(omega, B, loads, tolerance);
  EXPECT_LT((metres.B - millimetres.B).norm(), 1e-13 * metres.B.norm());  // round-off
}

}  // namespace
}  // namespace chladni::mbs_export
