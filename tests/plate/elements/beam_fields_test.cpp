#include "plate/elements/beam_element.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "plate/elements/geometric_stiffness.hpp"
#include "sample_elements.hpp"
#include "tests/plate/beam_lines.hpp"

namespace chladni::plate {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::beam_mesh;
using testing::circle;
using testing::deep_beam;
using testing::frequencies;
using testing::held;
using testing::line;
using testing::ring_lines;

using std::numbers::pi;

/// A line of a quarter turn that also climbs, so that its axis is no plane curve.
NodeVectors helix(int order)
{
  NodeVectors x(order + 1, 3);
  for (int i = 0; i <= order; ++i) {
    const double angle = 0.5 * pi * i / order;
    x.row(i) << std::cos(angle), std::sin(angle), 0.4 * angle * angle;
  }
  return x;
}

BeamSection uneven_section(BeamTheory theory)
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

class CurvedLine : public ::testing::TestWithParam<int> {};

TEST_P(CurvedLine, HasSixMotionsWithoutStrainAndNoMore)
{
  const NodeVectors x = helix(GetParam());
  for (const BeamTheory theory : {BeamTheory::bernoulli_euler, BeamTheory::timoshenko}) {
    const MatrixXd K = beam_matrices(x, uneven_section(theory)).K;
    EXPECT_LT((K * testing::rigid_motions(x)).norm(), 1e-13 * K.norm());  // round-off
    const VectorXd lambda = Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues();
    EXPECT_LT(lambda.head(6).cwiseAbs().maxCoeff(), 1e-13 * lambda.maxCoeff());
    EXPECT_GT(lambda[6], 1e-9 * lambda.maxCoeff());  // shear is 1e5 times stiffer without it
  }
}

TEST_P(CurvedLine, FeelsUniformStretchAndTwistWhereverItsNodesStand)
{
  const int p = GetParam();
  NodeVectors x = line({0, 0, 0}, {1.2, 0, 0}, p);
  for (int i = 1; i < p; ++i) x(i, 0) += 0.05 * (i % 2 == 1 ? 1.0 : -0.5);
  const BeamSection section = uneven_section(BeamTheory::timoshenko);
  VectorXd u = VectorXd::Zero(6 * (p + 1));
  for (Index i = 0; i <= p; ++i) {
    u[6 * i] = 1e-3 * x(i, 0);
    u[6 * i + 3] = 2e-3 * x(i, 0);
  }
  const VectorXd forces = beam_section_forces(x, section) * u;
  for (Index i = 0; i <= p; ++i) {
    VectorXd exact = VectorXd::Zero(6);
    exact[0] = 1e-3 * 2.1 * section.area;
    exact[3] = 2e-3 * 2.1 / 2.6 * section.J;
    EXPECT_LT((forces.segment<6>(6 * i) - exact).norm(), 1e-11 * exact.norm());  // round-off
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, CurvedLine, ::testing::Values(2, 3, 4));

double rate(double coarse, double fine)
{
  return std::log2(std::abs(coarse / fine));
}

TEST(TimoshenkoLine, VibratesAtTheFrequenciesOfADeepBeamWithTheOrderOfTheShells)
{
  const BeamSection deep = deep_beam();
  for (const int order : {2, 3}) {
    const Index n = order == 2 ? 96 : 24;  // so that both are isoparametric
    const VectorXd coarse =
        testing::simply_supported_frequencies(deep, {.length = 10.0, .order = order, .n = n});
    const VectorXd fine =
        testing::simply_supported_frequencies(deep, {.length = 10.0, .order = order, .n = 2 * n});
    for (int mode = 2; mode <= 4; ++mode) {
      const double exact = testing::timoshenko_frequency(deep, 10.0, mode);
      EXPECT_GT(rate(coarse[mode - 1] / exact - 1.0, fine[mode - 1] / exact - 1.0),
                2.0 * order - 0.3)
          << order << " " << mode;
    }
  }
}

TEST(TimoshenkoLine, IsFarCloserThanTwoNodeBeamsWithAsManyNodesWhereItIsSlender)
{
  const BeamSection slender = deep_beam(0.2);
  const auto of_order = [&](int order) {
    return testing::simply_supported_frequencies(slender,
                                                 {.length = 10.0, .order = order, .n = 12});
  };
  const VectorXd two_nodes = of_order(1);
  for (const int order : {2, 3, 4}) {
    const VectorXd omega = of_order(order);
    for (int mode = 1; mode <= 4; ++mode) {
      const double exact = testing::timoshenko_frequency(slender, 10.0, mode);
      EXPECT_LT(std::abs(omega[mode - 1] / exact - 1.0),
                0.02 * std::abs(two_nodes[mode - 1] / exact - 1.0))
          << order << " " << mode;
    }
  }
}

TEST(TimoshenkoLine, TwistsAndStretchesWithTwiceItsOrder)
{
  const BeamSection s = deep_beam();
  const double G = 2e11 / 2.6;
  const double torsion = std::sqrt(G * s.J / (8000.0 * (s.I_y + s.I_z))) * pi / 20.0;
  const double axial = std::sqrt(2e11 / 8000.0) * pi / 20.0;
  for (const int order : {2, 3}) {
    const auto error = [&](Index n, double exact) {
      const VectorXd omega = frequencies(
          held(beam_mesh(line({0, 0, 0}, {10, 0, 0}, n), order, s), {0, 1, 2, 3, 4, 5}));
      return (omega.array() / exact - 1.0).abs().minCoeff();
    };
    for (const double exact : {3.0 * torsion, 3.0 * axial})
      EXPECT_GT(rate(error(12, exact), error(24, exact)), 2.0 * order - 0.3) << order;
  }
}

/// The lowest frequencies with n waves around a ring, in its plane and out of it, rad/s.
struct RingFrequencies {
  double in_plane, out_of_plane;
};

/// Exact: u = a(e_x) sin or cos (n s / R) makes K and M of three unknowns. Radius R = 1 m.
RingFrequencies exact_ring(const BeamSection& s, int n)
{
  const double E = s.material.young, G = 0.5 * E / (1.0 + s.material.poisson);
  const double rho = s.material.density, A = s.area, k = n, c = 1.0;
  const auto lowest = [](const Matrix3d& B, const Eigen::Vector3d& C, const Eigen::Vector3d& m) {
    const Matrix3d K = B.transpose() * C.asDiagonal() * B, M = m.asDiagonal();
    return std::sqrt(Eigen::GeneralizedSelfAdjointEigenSolver<Matrix3d>(K, M).eigenvalues()[0]);
  };
  Matrix3d in, out;
  in << k, -c, 0, c, -k, -1, 0, 0, k;   // u_x ~ sin, u_y ~ cos, theta_z ~ sin: eps, gamma, kappa
  out << -k, 0, 1, 0, -k, -c, 0, c, k;  // u_z ~ cos, theta_x ~ cos, theta_y ~ sin
  return {.in_plane = lowest(in, {E * A, s.shear_factor_y * G * A, E * s.I_z},
                             {rho * A, rho * A, rho * s.I_z}),
          .out_of_plane = lowest(out, {s.shear_factor_z * G * A, G * s.J, E * s.I_y},
                                 {rho * A, rho * (s.I_y + s.I_z), rho * s.I_y})};
}

/// b wide in the plane of the ring, h high.
BeamSection rectangle(double b, double h)
{
  return {.group = "ring",
          .material = {.young = 2e11, .poisson = 0.3, .density = 8000.0},
          .area = b * h,
          .I_y = b * h * h * h / 12.0,
          .I_z = h * b * b * b / 12.0,
          .J = 0.2 * b * h * h * h,
          .shear_factor_y = 0.85,
          .shear_factor_z = 0.85,
          .orientation = std::array{0.0, 0.0, 1.0}};
}

/// All frequencies of a ring of n nodes, rad/s.
VectorXd ring_frequencies(const BeamSection& section, int order, Index n)
{
  const ElementMatrices ring = testing::matrices_of(circle(1.0, n), ring_lines(n, order), section);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(ring.K, ring.M,
                                                                  Eigen::EigenvaluesOnly);
  return solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
}

double error_of(double exact, const VectorXd& omega)
{
  return (omega.array() / exact - 1.0).abs().minCoeff();
}

TEST(CurvedRing, VibratesAtItsExactFrequenciesWhetherThickOrThin)
{
  for (const BeamSection& section : {rectangle(0.3, 0.2), rectangle(0.03, 0.02)}) {
    for (const int order : {2, 3, 4}) {
      const VectorXd coarse = ring_frequencies(section, order, 24);
      const VectorXd fine = ring_frequencies(section, order, 48);
      for (const int n : {2, 3}) {
        const RingFrequencies exact = exact_ring(section, n);
        for (const double omega : {exact.in_plane, exact.out_of_plane}) {
          // The circle through the nodes of a line of order 3 is off by h^4.
          EXPECT_GT(rate(error_of(omega, coarse), error_of(omega, fine)), 3.8) << order << " " << n;
          EXPECT_LT(error_of(omega, fine), order == 2 ? 1e-3 : 5e-5) << order << " " << n;
        }
      }
    }
  }
}

TEST(CurvedRing, ThatIsRigidInShearVibratesAsLovesRing)
{
  for (const double b : {0.03, 0.003}) {
    BeamSection section = rectangle(b, b / 1.5);
    section.theory = BeamTheory::bernoulli_euler;
    const double EI = 2e11 * section.I_z, m = 8000.0 * section.area;
    const double EI_y = 2e11 * section.I_y, GJ = 2e11 / 2.6 * section.J;
    const VectorXd omega = ring_frequencies(section, 4, 48);
    for (const double n : {2.0, 3.0}) {
      const double shape = n * n * (n * n - 1.0) * (n * n - 1.0);
      // Inextensible, without inertia of rotation and twist: off by up to (b n / R)^2 / 4. A
      // stiffness against shear of 1e5 12 EI / l^2 leaves (n l / R)^2 / 24e5, 48 nodes about 5e-5.
      const double allowed = std::pow(b * n, 2) / 4.0 + 1e-4;
      EXPECT_LT(error_of(std::sqrt(EI / m * shape / (n * n + 1.0)), omega), allowed) << n;
      EXPECT_LT(error_of(std::sqrt(EI_y / m * shape / (n * n + EI_y / GJ)), omega), allowed) << n;
    }
  }
}

TEST(CurvedRing, ThatIsStretchedHoldsItsOutOfPlaneWavesAsAString)
{
  const BeamSection section = rectangle(0.03, 0.02);
  const double outwards = 1e-4, N = 2e11 * section.area * outwards;
  for (const int order : {2, 3}) {
    const NodeVectors x = circle(1.0, 48);
    VectorXd u = VectorXd::Zero(6 * 48), wave = u;
    for (Index i = 0; i < 48; ++i) {
      u.segment<3>(6 * i) = outwards * x.row(i).transpose();
      wave[6 * i + 2] = std::cos(3.0 * 2.0 * pi * double(i) / 48.0);
    }
    const MatrixXd K = testing::assembled(
        x, ring_lines(48, order), [&](const NodeVectors& of_line, const std::vector<Index>& dofs) {
          return beam_geometric_stiffness(of_line, section, u(dofs));
        });
    // int N (3 sin 3 phi)^2 d phi; the wave is one of polynomials
    EXPECT_NEAR(wave.dot(K * wave) / (9.0 * pi * N), 1.0, order == 2 ? 5e-3 : 1e-3) << order;
  }
}

TEST(StraightLine, BucklesAtEulersLoad)
{
  for (const int order : {1, 2, 3, 4}) {
    BeamSection section = deep_beam(0.2);
    section.theory = BeamTheory::bernoulli_euler;
    const NodeVectors x = line({0, 0, 0}, {10, 0, 0}, 12);
    VectorXd u = VectorXd::Zero(6 * 13);
    const double N = -1.0;
    for (Index i = 0; i < 13; ++i) u[6 * i] = N / (2e11 * section.area) * x(i, 0);
    std::vector<std::vector<Index>> lines = ring_lines(12, order);
    lines.back().back() = 12;
    const MatrixXd G = testing::assembled(
        x, lines, [&](const NodeVectors& of_line, const std::vector<Index>& dofs) {
          return beam_geometric_stiffness(of_line, section, u(dofs));
        });
    const ElementMatrices free =
        testing::in_plane({.K = testing::matrices_of(x, lines, section).K, .M = -G});
    const ElementMatrices cantilever = held(free, {0, 1});
    // K v = P (-G) v; 1 / P of -G - K, since K is the definite one
    const double P =
        1.0 / Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(cantilever.M, cantilever.K)
                  .eigenvalues()
                  .maxCoeff();
    const double euler = pi * pi * 2e11 * section.I_y / 400.0;
    // N turns the sections too, N I / A psi'^2: P = euler (1 - P / EA ...), 1e-4 of it here
    EXPECT_NEAR(P / (euler / (1.0 + euler / (2e11 * section.area))), 1.0, 2e-6) << order;
  }
}

TEST(NodeAxes, FollowACurvedLineAndStaySquareToItsPlaneWhereNothingIsSaid)
{
  NodeVectors x(3, 3);  // a quarter of a vertical circle, which ends along z
  const double r = std::sqrt(0.5);
  x << 1.0, 0.0, 0.0, r, 0.0, r, 0.0, 0.0, 1.0;
  BeamSection round = deep_beam();
  round.orientation.reset();
  const std::vector<Matrix3d> axes = node_axes(x, round);
  for (const Matrix3d& of_node : axes) {
    EXPECT_LT((of_node * of_node.transpose() - Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(std::abs(of_node(2, 1)), 1.0, 1e-14);  // e_z
  }
  EXPECT_LT((axes[0].row(2) - axes[2].row(2)).norm(), 1e-14);
  EXPECT_NEAR(axes[1].row(0).dot(Eigen::RowVector3d(-r, 0.0, r)), 1.0, 1e-14);
  const NodeVectors elsewhere = x.rowwise() + Eigen::RowVector3d(3.0, -2.0, 0.5);
  const std::vector<Matrix3d> there = node_axes(elsewhere, round);
  for (std::size_t i = 0; i < axes.size(); ++i) EXPECT_LT((there[i] - axes[i]).norm(), 1e-14) << i;
}

}  // namespace
}  // namespace chladni::plate
