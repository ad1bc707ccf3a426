#include "mbs_export/make_body.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/check_body.hpp"
#include "mbs_export/files/body_files.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

constexpr double pi = std::numbers::pi;

BodyOptions held()
{
  BodyOptions options;
  options.fixed = {"hub"};
  options.damping = {.type = Damping::Type::matrix};
  return options;
}

/// A part of the wheel's stiffness that is semidefinite: what its first half of masters shares.
MatrixXd part_of(const MatrixXd& K)
{
  const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(K);
  VectorXd kept = modes.eigenvalues().cwiseMax(0.0);
  for (Index i = 0; i < kept.size(); i += 2) kept[i] = 0.0;
  return modes.eigenvectors() * kept.asDiagonal() * modes.eigenvectors().transpose();
}

TEST(LossFactors, OfOneMaterialGiveLambdaOfTheClosedForm)
{
  // lambda = omega^2 (1 + i eta), whatever the modes.
  constexpr double eta = 0.03;
  ReducedSystem wheel = test::wheel();
  wheel.H = eta * wheel.K;
  const ModalBody body = make_body(wheel, held());
  const MatrixXcd A =
      MatrixXd(body.omega.cwiseAbs2().asDiagonal()).cast<Complex>() + Complex(0.0, 1.0) * body.H;
  for (Index i = 0; i < body.n_modes(); ++i) {
    const Complex expected = body.omega[i] * body.omega[i] * Complex(1.0, eta);
    EXPECT_LT((A.eigenvalues().array() - expected).abs().minCoeff(), 1e-9 * std::abs(expected));
  }
  EXPECT_LT((loss_factors(body).array() / eta - 1.0).abs().maxCoeff(), 1e-9);
  // The viscous equivalent: eta omega of each mode, nothing between them.
  EXPECT_LT((body.C - MatrixXd((eta * body.omega).asDiagonal())).norm(), 1e-9 * body.C.norm());
}

TEST(LossFactors, OfRigidMotionsAreZero)
{
  constexpr double eta = 0.03;
  ReducedSystem wheel = test::wheel();
  wheel.H = eta * wheel.K;
  BodyOptions free = held();
  free.fixed.clear();
  const ModalBody body = make_body(wheel, free);
  ASSERT_GT(body.n_free_rigid, 0);
  const VectorXd found = loss_factors(body);
  for (Index i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], body.omega[i] > 0.0 ? eta : 0.0, 1e-6) << i;  // K of a free body, rounded
}

TEST(LossFactors, OfSeveralMaterialsAreWeightedByEnergy)
{
  // eta = sum eta_e U_e / sum U_e of the elastic energies in the mode.
  const ReducedSystem plain = test::wheel();
  ReducedSystem lossy = plain;
  const MatrixXd soft = part_of(plain.K), rest = plain.K - soft;
  lossy.H = 0.2 * soft + 0.01 * rest;
  const ModalBody body = make_body(lossy, held());
  BodyOptions undamped = held();
  undamped.damping = {};
  ReducedSystem of_soft = plain, of_rest = plain;
  of_soft.H = soft;
  of_rest.H = rest;
  const VectorXd U_soft = make_body(of_soft, held()).H.diagonal(),
                 U_rest = make_body(of_rest, held()).H.diagonal();
  const VectorXd expected = (0.2 * U_soft + 0.01 * U_rest).cwiseQuotient(U_soft + U_rest);
  EXPECT_LT((loss_factors(body) - expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT(expected.maxCoeff() / expected.minCoeff(), 2.0);
  EXPECT_EQ(make_body(lossy, undamped).H.size(), 0);
}

TEST(ViscousEquivalent, DissipatesInAModeWhatTheLossFactorDoes)
{
  // Half powers: the response of C at its own resonance is that of H.
  const ReducedSystem plain = test::wheel();
  ReducedSystem lossy = plain;
  lossy.H = 0.02 * part_of(plain.K);
  const ModalBody body = make_body(lossy, held());
  for (Index i = 0; i < body.n_modes(); ++i)
    EXPECT_NEAR(body.C(i, i) * body.omega[i], body.H(i, i), 1e-12 * body.H.diagonal().maxCoeff());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> values(body.C, Eigen::EigenvaluesOnly);
  EXPECT_GT(values.eigenvalues()[0], -1e-12 * values.eigenvalues().maxCoeff());
}

TEST(ViscousEquivalent, HasTheEigenvaluesOfSmallLossFactorsToFirstOrder)
{
  // Damping between modes of one frequency counts in full, between others to second order.
  const VectorXd omega = Eigen::Vector4d(1000.0, 1000.0, 1001.0, 1700.0);
  MatrixXd H(4, 4);
  H << 2.0, 1.2, 0.4, 0.3, 1.2, 1.5, 0.2, 0.1, 0.4, 0.2, 1.0, 0.5, 0.3, 0.1, 0.5, 2.5;
  const auto largest_error = [&](double eta) {
    const MatrixXd H_eta = eta * 1e6 * H, C = viscous_equivalent(H_eta, omega);
    MatrixXd A = MatrixXd::Zero(8, 8);
    A.topRightCorner(4, 4).setIdentity();
    A.bottomLeftCorner(4, 4).diagonal() = -omega.cwiseAbs2();
    A.bottomRightCorner(4, 4) = -C;
    const VectorXcd of_C = A.eigenvalues();
    const MatrixXcd K =
        MatrixXd(omega.cwiseAbs2().asDiagonal()).cast<Complex>() + Complex(0.0, 1.0) * H_eta;
    double largest = 0.0;
    for (const Complex& square : VectorXcd(K.eigenvalues())) {
      const Complex lambda = Complex(0.0, 1.0) * std::sqrt(square);
      largest = std::max(largest, (of_C.array() - lambda).abs().minCoeff() / std::abs(lambda));
    }
    return largest;
  };
  const double coarse = largest_error(1e-2), fine = largest_error(1e-3);
  // The next terms of lambda are half the square of the loss factors.
  const double eta = 1e-3 * H.norm();
  EXPECT_LT(fine, 0.5 * eta * eta);
  EXPECT_GT(std::log10(coarse / fine), 1.9);
}

TEST(DampingRatios, OverTheFrequencyAreLinearAndEndWithTheirTable)
{
  const ReducedSystem wheel = test::wheel();
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.count = 6;
  const VectorXd f = make_body(wheel, options).omega / (2.0 * pi);
  const double last = f[f.size() - 1];
  options.damping = {.type = Damping::Type::modal, .ratios = {0.001, 0.005}, .at_Hz = {0.0, last}};
  const ModalBody body = make_body(wheel, options);
  for (Index i = 0; i < f.size(); ++i)
    EXPECT_NEAR(0.5 * body.C(i, i) / body.omega[i], 0.001 + 0.004 * f[i] / last, 1e-12);
  options.damping.at_Hz = {0.0, 0.5 * last};
  const std::string complaint = files::test::error_of([&] { make_body(wheel, options); });
  EXPECT_NE(complaint.find("damping.ratio: mode"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("the ratios are given from 0 to"), std::string::npos) << complaint;
}

TEST(LossFactors, ComeBackFromTheFiles)
{
  ReducedSystem wheel = test::wheel();
  wheel.H = 0.03 * wheel.K;
  const files::test::ScratchFolder folder;
  write_reduced(folder.file("a.reduced.h5"), wheel);
  EXPECT_EQ(read_reduced(folder.file("a.reduced.h5")).H, wheel.H);
  const ModalBody body = make_body(wheel, held());
  write_body(folder.file("a.body.h5"), body);
  EXPECT_EQ(read_body(folder.file("a.body.h5")).H, body.H);
  for (const Check& check : check_body(body)) EXPECT_NE(check.verdict, Verdict::fail) << check.name;
}

}  // namespace
}  // namespace chladni::mbs_export
