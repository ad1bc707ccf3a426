#include "plate/elements/beam_element.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "sample_elements.hpp"

namespace chladni::plate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVector3d;
using Eigen::VectorXd;
using testing::rigid_motions;

constexpr double pi = std::numbers::pi;

/// A section of which no two constants are alike.
BeamSection uneven(BeamTheory theory)
{
  return {.group = "beam",
          .material = {.young = 2.1, .poisson = 0.3, .density = 1.7},
          .theory = theory,
          .area = 0.3,
          .I_y = 0.02,
          .I_z = 0.05,
          .J = 0.04,
          .shear_factor_y = 0.8,
          .shear_factor_z = 0.7,
          .orientation = std::array{0.1, 0.3, 1.0}};
}

/// Along x with y and z the global ones.
BeamSection aligned(BeamTheory theory)
{
  BeamSection section = uneven(theory);
  section.orientation = std::array{0.0, 0.0, 1.0};
  return section;
}

NodeVectors line(const RowVector3d& a, const RowVector3d& b, Index n_elements)
{
  NodeVectors x(n_elements + 1, 3);
  for (Index i = 0; i <= n_elements; ++i) x.row(i) = a + double(i) / double(n_elements) * (b - a);
  return x;
}

/// The matrices without the rows and columns of held DOFs.
ElementMatrices held(const ElementMatrices& free, const std::vector<Index>& held_dofs)
{
  std::vector<Index> rest;
  for (Index i = 0; i < free.K.rows(); ++i)
    if (std::ranges::find(held_dofs, i) == held_dofs.end()) rest.push_back(i);
  return {.K = free.K(rest, rest), .M = free.M(rest, rest)};
}

ElementMatrices cantilever(const BeamSection& section, double length, Index n_elements)
{
  return held(beam_matrices(line({0, 0, 0}, {length, 0, 0}, n_elements), section),
              {0, 1, 2, 3, 4, 5});
}

/// Displacement of the last node for a unit load there, [6 x 6].
MatrixXd tip_flexibility(const BeamSection& section, double length, Index n_elements)
{
  const MatrixXd K = cantilever(section, length, n_elements).K;
  return K.inverse().bottomRightCorner<6, 6>();
}

VectorXd frequencies(const ElementMatrices& system)
{
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(system.M, system.K);
  return solver.eigenvalues().reverse().cwiseInverse().cwiseSqrt();
}

class BeamElement : public ::testing::TestWithParam<BeamTheory> {};

TEST_P(BeamElement, HasExactlySixZeroModes)
{
  const MatrixXd K = beam_matrices(line({0, 0, 0}, {0.3, 0.5, -0.7}, 3), uneven(GetParam())).K;
  const VectorXd lambda = Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues();
  EXPECT_LT(lambda.head(6).cwiseAbs().maxCoeff(), 1e-13 * lambda.maxCoeff());  // round-off
  EXPECT_GT(lambda[6], 1e-4 * lambda.maxCoeff());
}

TEST_P(BeamElement, FeelsNoForceInRigidMotion)
{
  const NodeVectors x = line({0.2, 0, 0.1}, {0.3, 0.5, -0.7}, 2);
  const MatrixXd K = beam_matrices(x, uneven(GetParam())).K;
  EXPECT_LT((K * rigid_motions(x)).cwiseAbs().maxCoeff(), 1e-13 * K.cwiseAbs().maxCoeff());
}

TEST_P(BeamElement, TurnsWithTheFrame)
{
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const BeamSection section = uneven(GetParam());
  BeamSection turned = section;
  const Eigen::Vector3d v = R * Eigen::Vector3d(section.orientation->data());
  turned.orientation = std::array{v[0], v[1], v[2]};
  const NodeVectors x = line({0, 0, 0}, {0.3, 0.5, -0.7}, 2);
  MatrixXd T = MatrixXd::Zero(18, 18);
  for (Index i = 0; i < 18; i += 3) T.block<3, 3>(i, i) = R;
  const ElementMatrices here = beam_matrices(x, section);
  const ElementMatrices there = beam_matrices(x * R.transpose(), turned);
  EXPECT_LT((T * here.K * T.transpose() - there.K).norm(), 1e-12 * here.K.norm());  // round-off
  EXPECT_LT((T * here.M * T.transpose() - there.M).norm(), 1e-12 * here.M.norm());
}

TEST_P(BeamElement, BendsTwistsAndStretchesExactlyUnderTipLoads)
{
  const BeamSection s = aligned(GetParam());
  const double L = 1.3, E = 2.1, G = 2.1 / 2.6, A = 0.3;
  const bool shears = GetParam() == BeamTheory::timoshenko;
  const double shear_y = shears ? L / (0.8 * G * A) : 0.0;
  const double shear_z = shears ? L / (0.7 * G * A) : 0.0;
  Eigen::Matrix<double, 6, 6> exact = Eigen::Matrix<double, 6, 6>::Zero();
  exact.diagonal() << L / (E * A), L * L * L / (3.0 * E * s.I_z) + shear_y,
      L * L * L / (3.0 * E * s.I_y) + shear_z, L / (G * s.J), L / (E * s.I_y), L / (E * s.I_z);
  exact(1, 5) = exact(5, 1) = L * L / (2.0 * E * s.I_z);   // theta_z = v'
  exact(2, 4) = exact(4, 2) = -L * L / (2.0 * E * s.I_y);  // theta_y = -w'
  for (const Index n_elements : {1, 3})
    EXPECT_LT((tip_flexibility(s, L, n_elements) - exact).norm(), 1e-12 * exact.norm());
}

TEST_P(BeamElement, HasTheMassAndInertiaOfAStraightBar)
{
  const BeamSection s = aligned(GetParam());
  const double L = 1.3, m = 1.7 * 0.3 * L;
  const NodeVectors x = line({-L / 2, 0, 0}, {L / 2, 0, 0}, 2);
  const MatrixXd R = rigid_motions(x);
  const MatrixXd J = R.transpose() * beam_matrices(x, s).M * R;
  Eigen::Matrix<double, 6, 6> exact = Eigen::Matrix<double, 6, 6>::Zero();
  exact.diagonal() << m, m, m, 1.7 * L * (s.I_y + s.I_z), m * L * L / 12.0 + 1.7 * L * s.I_y,
      m * L * L / 12.0 + 1.7 * L * s.I_z;
  EXPECT_LT((J - exact).norm(), 1e-13 * exact.norm());  // round-off
}

TEST_P(BeamElement, FindsTheSectionForcesOfACantilever)
{
  const BeamSection s = aligned(GetParam());
  const NodeVectors x = line({0, 0, 0}, {1.2, 0, 0}, 3);
  // Force (1, 2, 3) and moment (4, 5, 6) at the tip; at x the moment grows by the arm 1.2 - x.
  VectorXd load(6);
  load << 1, 2, 3, 4, 5, 6;
  VectorXd u = VectorXd::Zero(24);
  u.tail(18) = cantilever(s, 1.2, 3).K.inverse().rightCols(6) * load;
  const VectorXd forces = beam_section_forces(x, s) * u;
  for (int element = 0; element < 3; ++element) {
    for (int end = 0; end < 2; ++end) {
      const double arm = 1.2 - 0.4 * (element + end);
      VectorXd exact = load;
      exact[4] -= arm * 3.0;
      exact[5] += arm * 2.0;
      const VectorXd found = forces.segment<6>(12 * element + 6 * end);
      EXPECT_LT((found - exact).norm(), 1e-11) << element << " " << end;  // round-off
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Theories, BeamElement,
                         ::testing::Values(BeamTheory::bernoulli_euler, BeamTheory::timoshenko),
                         [](const auto& theory) {
                           return theory.param == BeamTheory::timoshenko ? "Timoshenko"
                                                                         : "BernoulliEuler";
                         });

/// Bending in the x-z plane alone: u_z and theta_y of each node.
ElementMatrices in_plane(const ElementMatrices& all)
{
  std::vector<Index> dofs;
  for (Index i = 0; i < all.K.rows(); i += 6) dofs.insert(dofs.end(), {i + 2, i + 4});
  return {.K = all.K(dofs, dofs), .M = all.M(dofs, dofs)};
}

TEST(BernoulliEulerBeam, VibratesAtTheFrequenciesOfACantilever)
{
  BeamSection s = aligned(BeamTheory::bernoulli_euler);
  s.has_rotary_inertia = false;
  const ElementMatrices beam =
      held(in_plane(beam_matrices(line({0, 0, 0}, {1.3, 0, 0}, 20), s)), {0, 1});
  const double scale = std::sqrt(2.1 * s.I_y / (1.7 * 0.3)) / (1.3 * 1.3);
  const VectorXd omega = frequencies(beam);
  // Roots of 1 + cos x cosh x = 0; cubic elements err by (beta h)^4 / 1440 in the frequency.
  const std::array roots{1.875104068711961, 4.694091132974175, 7.854757438237612};
  for (int n = 0; n < 3; ++n) {
    const double exact = roots[n] * roots[n] * scale;
    EXPECT_NEAR(omega[n] / exact, 1.0, 1.2 * std::pow(roots[n] / 20.0, 4) / 1440.0);
    EXPECT_GE(omega[n] / exact, 1.0 - 1e-10);
  }
}

/// Frequency of the n-th mode of a simply supported beam, rad/s: the lower root of
/// (rho^2 I / kG) w^4 - (rho A + rho I k^2 (1 + E / kG)) w^2 + EI k^4 = 0, k = n pi / L.
double timoshenko_frequency(const BeamSection& s, double L, int n)
{
  const double E = s.material.young, rho = s.material.density;
  const double kG = s.shear_factor_z * 0.5 * E / (1.0 + s.material.poisson);
  const double k2 = std::pow(n * pi / L, 2);
  const double a = rho * rho * s.I_y / kG;
  const double b = rho * s.area + rho * s.I_y * k2 * (1.0 + E / kG);
  const double c = E * s.I_y * k2 * k2;
  return std::sqrt(2.0 * c / (b + std::sqrt(b * b - 4.0 * a * c)));
}

/// The deep beam of NAFEMS FV5: 10 m long, 2 m by 2 m.
BeamSection deep_beam()
{
  return {.group = "beam",
          .material = {.young = 2e11, .poisson = 0.3, .density = 8000.0},
          .area = 4.0,
          .I_y = 4.0 / 3.0,
          .I_z = 4.0 / 3.0,
          .J = 0.1406 * 16.0,
          .shear_factor_y = 0.85,
          .shear_factor_z = 0.85};
}

VectorXd simply_supported_frequencies(const BeamSection& s, Index n_elements)
{
  return frequencies(held(in_plane(beam_matrices(line({0, 0, 0}, {10, 0, 0}, n_elements), s)),
                          {0, 2 * n_elements}));
}

TEST(TimoshenkoBeam, ConvergesToTheFrequenciesOfTheDeepSimplySupportedBeam)
{
  BeamSection s = deep_beam();
  s.orientation = std::array{0.0, 0.0, 1.0};
  const VectorXd coarse = simply_supported_frequencies(s, 10);
  const VectorXd fine = simply_supported_frequencies(s, 20);
  for (int n = 1; n <= 3; ++n) {
    const double exact = timoshenko_frequency(s, 10.0, n);
    const double order = std::log2((coarse[n - 1] / exact - 1.0) / (fine[n - 1] / exact - 1.0));
    EXPECT_GT(order, 1.9) << n;  // the inertia is that of static shapes: order 2 where shear counts
    EXPECT_LT(std::abs(fine[n - 1] / exact - 1.0), 3e-3 * n * n) << n;
  }
  // The published frequencies of this beam, six digits.
  EXPECT_NEAR(timoshenko_frequency(s, 10.0, 1) / (2.0 * pi), 42.6456, 1e-4);
  EXPECT_NEAR(timoshenko_frequency(s, 10.0, 2) / (2.0 * pi), 148.156, 1e-3);
  EXPECT_NEAR(timoshenko_frequency(s, 10.0, 3) / (2.0 * pi), 283.490, 1e-3);
}

TEST(BernoulliEulerBeam, WithRotaryInertiaIsRayleighsBeam)
{
  BeamSection s = deep_beam();
  s.theory = BeamTheory::bernoulli_euler;
  s.orientation = std::array{0.0, 0.0, 1.0};
  const VectorXd omega = simply_supported_frequencies(s, 40);
  for (int n = 1; n <= 3; ++n) {
    const double k2 = std::pow(n * pi / 10.0, 2);
    const double exact =
        std::sqrt(2e11 * s.I_y * k2 * k2 / (8000.0 * s.area + 8000.0 * s.I_y * k2));
    EXPECT_NEAR(omega[n - 1] / exact, 1.0, 1e-5) << n;  // (k h)^4 / 1440 with k h = 0.24 at most
  }
}

TEST(BeamElement, TwistsAndStretchesAtTheFrequenciesOfARod)
{
  const BeamSection s = deep_beam();
  const VectorXd omega =
      frequencies(held(beam_matrices(line({0, 0, 0}, {10, 0, 0}, 40), s), {0, 1, 2, 3, 4, 5}));
  const double G = 2e11 / 2.6;
  const double torsion = std::sqrt(G * s.J / (8000.0 * (s.I_y + s.I_z))) * pi / 20.0;
  const double axial = std::sqrt(2e11 / 8000.0) * pi / 20.0;
  for (const double exact : {torsion, axial}) {
    // Linear elements err by (k h)^2 / 24 = 6.4e-5.
    EXPECT_LT((omega.array() / exact - 1.0).abs().minCoeff(), 7e-5);
  }
}

/// What beam_axes says to `along` and an orientation.
std::string complaint(const RowVector3d& along, std::optional<std::array<double, 3>> orientation)
{
  BeamSection section = uneven(BeamTheory::timoshenko);
  section.orientation = orientation;
  try {
    beam_axes(along, section);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(BeamAxes, AreRefusedWhereTheyAreNotDefined)
{
  EXPECT_NE(complaint({1, 0, 0}, std::nullopt).find("give `orientation`"), std::string::npos);
  EXPECT_NE(complaint({0, 0, 2}, std::array{0.0, 0.0, 1.0}).find("parallel"), std::string::npos);
  EXPECT_NE(complaint({0, 0, 0}, std::array{0.0, 0.0, 1.0}).find("no length"), std::string::npos);
}

TEST(BeamAxes, NeedNoOrientationForARoundSection)
{
  const Eigen::Matrix3d axes = beam_axes({1, 2, 3}, deep_beam());
  EXPECT_LT((axes * axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-15);
}

}  // namespace
}  // namespace chladni::plate
