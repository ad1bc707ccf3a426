// The beams among the vibration cases of NAFEMS (R0015, R0016), at the frequencies published there.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "plate/dofs/point_elements.hpp"
#include "plate/elements/beam_element.hpp"
#include "tests/plate/beam_lines.hpp"

namespace chladni::plate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double pi = std::numbers::pi;
const Material beam_steel{.young = 2e11, .poisson = 0.3, .density = 8000.0};

/// A line of 10 m along x.
NodeVectors ten_metres(Index n_elements)
{
  NodeVectors x = NodeVectors::Zero(n_elements + 1, 3);
  x.col(0) = VectorXd::LinSpaced(n_elements + 1, 0.0, 10.0);
  return x;
}

/// The lowest frequencies of a beam whose held DOFs do not move, Hz.
VectorXd frequencies(const ElementMatrices& beam, const std::vector<Index>& held, Index n_wanted)
{
  std::vector<Index> free;
  for (Index i = 0; i < beam.K.rows(); ++i)
    if (std::ranges::find(held, i) == held.end()) free.push_back(i);
  // 1 / omega^2 of M - K, since K has the larger numbers.
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(beam.M(free, free),
                                                                  beam.K(free, free));
  return solver.eigenvalues().reverse().head(n_wanted).cwiseInverse().cwiseSqrt() / (2.0 * pi);
}

void expect_each(const VectorXd& f_Hz, const std::vector<double>& targets, double within)
{
  for (std::size_t i = 0; i < targets.size(); ++i)
    EXPECT_NEAR(f_Hz[static_cast<Index>(i)] / targets[i], 1.0, within) << "mode " << i + 1;
}

// FV4: a rod of 0.5 m diameter with 10 t and 1 t on rigid arms of 2 m to both sides of its tip.
TEST(NafemsBeams, CantileverWithOffCentreMasses)
{
  const double d = 0.5, I = pi * d * d * d * d / 64.0;
  const BeamSection rod{.group = "rod",
                        .material = beam_steel,
                        .theory = BeamTheory::bernoulli_euler,
                        .area = pi * d * d / 4.0,
                        .I_y = I,
                        .I_z = I,
                        .J = 2.0 * I};
  const Index n = 20;
  ElementMatrices beam = testing::beam_mesh(ten_metres(n), 1, rod);
  for (const auto& [mass, y] : {std::pair{1e4, 2.0}, {1e3, -2.0}}) {
    beam.M.bottomRightCorner<6, 6>() +=
        point_mass_matrix({.at = "tip", .mass = mass, .offset = {0.0, y, 0.0}});
  }
  // The last digit of the first three. Shear would lower the others by up to 1 %: the published
  // values are those of a beam that is rigid in shear, and 1.5e-3 below it.
  expect_each(frequencies(beam, {0, 1, 2, 3, 4, 5}, 6),
              {1.723, 1.727, 7.413, 9.972, 18.155, 26.957}, 1e-3);
}

// FV5: 2 m by 2 m, x = y = z = rx = 0 at one end, y = z = 0 at the other.
TEST(NafemsBeams, DeepSimplySupportedBeam)
{
  const BeamSection deep{.group = "deep",
                         .material = beam_steel,
                         .area = 4.0,
                         .I_y = 4.0 / 3.0,
                         .I_z = 4.0 / 3.0,
                         .J = 0.1406 * 16.0,
                         .shear_factor_y = 0.85,
                         .shear_factor_z = 0.85};
  const Index n = 40;
  const VectorXd f = frequencies(testing::beam_mesh(ten_metres(n), 1, deep),
                                 {0, 1, 2, 3, 6 * n + 1, 6 * n + 2}, 9);
  // R0016; the inertia of static shapes leaves 2.5e-4 n^2 in bending, linear twist (k h)^2 / 24.
  expect_each(f, {42.650, 42.650, 71.200, 125.00, 148.15, 148.15, 213.61, 283.47, 283.47}, 3e-3);
}

}  // namespace
}  // namespace chladni::plate
