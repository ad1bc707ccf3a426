#include "plate/elements/beam_element.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <tuple>

#include "common/error.hpp"
#include "sample_elements.hpp"
#include "tests/plate/beam_lines.hpp"

namespace chladni::plate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVector3d;
using Eigen::VectorXd;
using testing::beam_mesh;
using testing::frequencies;
using testing::held;
using testing::in_plane;
using testing::line;
using testing::rigid_motions;

using std::numbers::pi;

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

/// One line of the order, held at its first node.
ElementMatrices cantilever(const BeamSection& section, double length, Index order)
{
  return held(beam_matrices(line({0, 0, 0}, {length, 0, 0}, order), section), {0, 1, 2, 3, 4, 5});
}

/// Displacement of the last node for a unit load there, [6 x 6].
MatrixXd tip_flexibility(const BeamSection& section, double length, Index order)
{
  const MatrixXd K = cantilever(section, length, order).K;
  return K.inverse().bottomRightCorner<6, 6>();
}

/// A theory and the order of the line.
class BeamElement : public ::testing::TestWithParam<std::tuple<BeamTheory, int>> {
 protected:
  static BeamTheory theory() { return std::get<0>(GetParam()); }
  static int order() { return std::get<1>(GetParam()); }
};

TEST_P(BeamElement, HasExactlySixZeroModes)
{
  const MatrixXd K = beam_matrices(line({0, 0, 0}, {0.3, 0.5, -0.7}, order()), uneven(theory())).K;
  const VectorXd lambda = Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues();
  EXPECT_LT(lambda.head(6).cwiseAbs().maxCoeff(), 1e-13 * lambda.maxCoeff());  // round-off
  EXPECT_GT(lambda[6], 1e-5 * lambda.maxCoeff());
}

TEST_P(BeamElement, FeelsNoForceInRigidMotion)
{
  const NodeVectors x = line({0.2, 0, 0.1}, {0.3, 0.5, -0.7}, order());
  const MatrixXd K = beam_matrices(x, uneven(theory())).K;
  EXPECT_LT((K * rigid_motions(x)).cwiseAbs().maxCoeff(), 1e-13 * K.cwiseAbs().maxCoeff());
}

TEST_P(BeamElement, TurnsWithTheFrame)
{
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const BeamSection section = uneven(theory());
  BeamSection turned = section;
  const Eigen::Vector3d v = R * Eigen::Vector3d(section.orientation->data());
  turned.orientation = std::array{v[0], v[1], v[2]};
  const NodeVectors x = line({0, 0, 0}, {0.3, 0.5, -0.7}, order());
  MatrixXd T = MatrixXd::Zero(6 * x.rows(), 6 * x.rows());
  for (Index i = 0; i < T.rows(); i += 3) T.block<3, 3>(i, i) = R;
  const ElementMatrices here = beam_matrices(x, section);
  const ElementMatrices there = beam_matrices(x * R.transpose(), turned);
  EXPECT_LT((T * here.K * T.transpose() - there.K).norm(), 1e-12 * here.K.norm());  // round-off
  EXPECT_LT((T * here.M * T.transpose() - there.M).norm(), 1e-12 * here.M.norm());
}

TEST_P(BeamElement, BendsTwistsAndStretchesExactlyUnderTipLoads)
{
  const BeamSection s = aligned(theory());
  // In the shorter lines shear counts so much that they are isoparametric from order 2 on.
  for (const double L : {1.3, 0.2}) {
    const double E = 2.1, G = 2.1 / 2.6, A = 0.3;
    const bool shears = theory() == BeamTheory::timoshenko;
    const double shear_y = shears ? L / (0.8 * G * A) : 0.0;
    const double shear_z = shears ? L / (0.7 * G * A) : 0.0;
    Eigen::Matrix<double, 6, 6> exact = Eigen::Matrix<double, 6, 6>::Zero();
    exact.diagonal() << L / (E * A), L * L * L / (3.0 * E * s.I_z) + shear_y,
        L * L * L / (3.0 * E * s.I_y) + shear_z, L / (G * s.J), L / (E * s.I_y), L / (E * s.I_z);
    exact(1, 5) = exact(5, 1) = L * L / (2.0 * E * s.I_z);   // theta_z = v'
    exact(2, 4) = exact(4, 2) = -L * L / (2.0 * E * s.I_y);  // theta_y = -w'
    EXPECT_LT((tip_flexibility(s, L, order()) - exact).norm(), 1e-11 * exact.norm());
  }
}

TEST_P(BeamElement, HasTheMassAndInertiaOfAStraightBar)
{
  const BeamSection s = aligned(theory());
  const double L = 1.3, m = 1.7 * 0.3 * L;
  const NodeVectors x = line({-L / 2, 0, 0}, {L / 2, 0, 0}, order());
  const MatrixXd R = rigid_motions(x);
  const MatrixXd J = R.transpose() * beam_matrices(x, s).M * R;
  Eigen::Matrix<double, 6, 6> exact = Eigen::Matrix<double, 6, 6>::Zero();
  exact.diagonal() << m, m, m, 1.7 * L * (s.I_y + s.I_z), m * L * L / 12.0 + 1.7 * L * s.I_y,
      m * L * L / 12.0 + 1.7 * L * s.I_z;
  EXPECT_LT((J - exact).norm(), 1e-13 * exact.norm());  // round-off
}

TEST_P(BeamElement, FindsTheSectionForcesOfACantilever)
{
  const BeamSection s = aligned(theory());
  for (const double L : {1.2, 0.2}) {
    const Index n = order() + 1;
    const NodeVectors x = line({0, 0, 0}, {L, 0, 0}, order());
    // Force (1, 2, 3) and moment (4, 5, 6) at the tip; at x the moment grows by the arm L - x.
    VectorXd load(6);
    load << 1, 2, 3, 4, 5, 6;
    VectorXd u = VectorXd::Zero(6 * n);
    u.tail(6 * (n - 1)) = cantilever(s, L, order()).K.inverse().rightCols(6) * load;
    const VectorXd forces = beam_section_forces(x, s) * u;
    for (Index node = 0; node < n; ++node) {
      const double arm = L * (1.0 - double(node) / order());
      VectorXd exact = load;
      exact[4] -= arm * 3.0;
      exact[5] += arm * 2.0;
      // round-off, which the largest ratio of stiffnesses raises
      EXPECT_LT((forces.segment<6>(6 * node) - exact).norm(), 1e-9) << node << " " << L;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(TheoriesAndOrders, BeamElement,
                         ::testing::Combine(::testing::Values(BeamTheory::bernoulli_euler,
                                                              BeamTheory::timoshenko),
                                            ::testing::Values(1, 2, 3, 4)),
                         [](const auto& test) {
                           return (std::get<0>(test.param) == BeamTheory::timoshenko
                                       ? std::string("Timoshenko")
                                       : std::string("BernoulliEuler")) +
                                  std::to_string(std::get<1>(test.param));
                         });

TEST(BernoulliEulerBeam, VibratesAtTheFrequenciesOfACantilever)
{
  BeamSection s = aligned(BeamTheory::bernoulli_euler);
  s.has_rotary_inertia = false;
  const ElementMatrices beam =
      held(in_plane(beam_mesh(line({0, 0, 0}, {1.3, 0, 0}, 20), 1, s)), {0, 1});
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

/// Of two-node beams.
VectorXd frequencies_of_10_m(const BeamSection& s, Index n_elements)
{
  return testing::simply_supported_frequencies(s, {.length = 10.0, .order = 1, .n = n_elements});
}

TEST(TimoshenkoBeam, BendsInItsDeepPlaneAsOneThatIsDeepInBoth)
{
  // A flat bar: the shapes are those of the plane where shear counts most.
  for (const Index order : {2, 3, 4}) {
    BeamSection flat = aligned(BeamTheory::timoshenko);
    flat.I_z = 1e-6 * flat.I_y;
    BeamSection deep = flat;
    deep.I_z = flat.I_y;
    const NodeVectors x = line({0, 0, 0}, {0.1, 0, 0}, order);
    std::vector<Index> of_plane;
    for (Index i = 0; i <= order; ++i) of_plane.insert(of_plane.end(), {6 * i + 2, 6 * i + 4});
    const MatrixXd K = beam_matrices(x, flat).K(of_plane, of_plane);
    const MatrixXd K_deep = beam_matrices(x, deep).K(of_plane, of_plane);
    EXPECT_LT((K - K_deep).norm(), 1e-12 * K_deep.norm()) << order;  // round-off
    std::swap(flat.I_y, flat.I_z);                                   // and the other way round
    of_plane.clear();
    for (Index i = 0; i <= order; ++i) of_plane.insert(of_plane.end(), {6 * i + 1, 6 * i + 5});
    const MatrixXd K_swapped = beam_matrices(x, flat).K(of_plane, of_plane);
    const MatrixXd K_both = beam_matrices(x, deep).K(of_plane, of_plane);
    EXPECT_LT((K_swapped - K_both).norm(), 1e-12 * K_both.norm()) << order;
  }
}

TEST(TimoshenkoBeam, ConvergesToTheFrequenciesOfTheDeepSimplySupportedBeam)
{
  BeamSection s = testing::deep_beam();
  s.orientation = std::array{0.0, 0.0, 1.0};
  const VectorXd coarse = frequencies_of_10_m(s, 10);
  const VectorXd fine = frequencies_of_10_m(s, 20);
  for (int n = 1; n <= 3; ++n) {
    const double exact = testing::timoshenko_frequency(s, 10.0, n);
    const double order = std::log2((coarse[n - 1] / exact - 1.0) / (fine[n - 1] / exact - 1.0));
    EXPECT_GT(order, 1.9) << n;  // the inertia is that of static shapes: order 2 where shear counts
    EXPECT_LT(std::abs(fine[n - 1] / exact - 1.0), 3e-3 * n * n) << n;
  }
  // The published frequencies of this beam, six digits.
  EXPECT_NEAR(testing::timoshenko_frequency(s, 10.0, 1) / (2.0 * pi), 42.6456, 1e-4);
  EXPECT_NEAR(testing::timoshenko_frequency(s, 10.0, 2) / (2.0 * pi), 148.156, 1e-3);
  EXPECT_NEAR(testing::timoshenko_frequency(s, 10.0, 3) / (2.0 * pi), 283.490, 1e-3);
}

TEST(BernoulliEulerBeam, WithRotaryInertiaIsRayleighsBeam)
{
  BeamSection s = testing::deep_beam();
  s.theory = BeamTheory::bernoulli_euler;
  s.orientation = std::array{0.0, 0.0, 1.0};
  const VectorXd omega = frequencies_of_10_m(s, 40);
  for (int n = 1; n <= 3; ++n) {
    const double k2 = std::pow(n * pi / 10.0, 2);
    const double exact =
        std::sqrt(2e11 * s.I_y * k2 * k2 / (8000.0 * s.area + 8000.0 * s.I_y * k2));
    EXPECT_NEAR(omega[n - 1] / exact, 1.0, 1e-5) << n;  // (k h)^4 / 1440 with k h = 0.24 at most
  }
}

TEST(BeamElement, TwistsAndStretchesAtTheFrequenciesOfARod)
{
  const BeamSection s = testing::deep_beam();
  const VectorXd omega =
      frequencies(held(beam_mesh(line({0, 0, 0}, {10, 0, 0}, 40), 1, s), {0, 1, 2, 3, 4, 5}));
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
  BeamSection round = testing::deep_beam();
  round.orientation.reset();
  const Eigen::Matrix3d axes = beam_axes({1, 2, 3}, round);
  EXPECT_LT((axes * axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-15);
}

}  // namespace
}  // namespace chladni::plate
