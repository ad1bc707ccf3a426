#include "plate/assembly/recovery.hpp"

#include <gtest/gtest.h>

#include <array>

#include "square_plate.hpp"

namespace chladni::plate {
namespace {

using Eigen::MatrixXd;

constexpr double young = 2e11, poisson = 0.3, thickness = 0.01, offset = 0.03;
const std::array plate_sections{
    ShellSection{.group = "plate",
                 .material = {.young = young, .poisson = poisson, .density = 8000.0},
                 .thickness = thickness,
                 .offset = offset}};
const Structure structure{.shells = plate_sections};
constexpr double membrane = young * thickness / (1.0 - poisson * poisson);
constexpr double bending = membrane * thickness * thickness / 12.0;

/// Elements of 0.1 x 0.25 m.
mesh::Mesh two_section_plate()
{
  return testing::rectangle({.a = 0.3, .b = 0.5, .n_x = 3, .n_y = 2, .order = 2});
}

TEST(ElementEnergies, AreThoseOfStretchingAndBendingAtTheOffset)
{
  constexpr double strain = 1e-3, curvature = 0.02;
  const mesh::Mesh mesh = two_section_plate();
  MatrixXd motions = MatrixXd::Zero(6 * mesh.n_nodes(), 2);
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const double x = mesh.positions[static_cast<std::size_t>(node)][0];
    motions(6 * node, 0) = strain * x;
    motions(6 * node + 2, 1) = -curvature * x * x / 2.0;
    motions(6 * node + 4, 1) = curvature * x;
  }
  const MatrixXd energies = element_energies(mesh, structure, motions, PETSC_COMM_WORLD);
  ASSERT_EQ(energies.rows(), 6);
  const double half_area = 0.5 * 0.1 * 0.25;
  const double stretched = curvature * offset;
  for (Eigen::Index e = 0; e < 6; ++e) {
    EXPECT_NEAR(energies(e, 0) / (half_area * membrane * strain * strain), 1.0, 1e-9);
    EXPECT_NEAR(energies(e, 1) / (half_area * (membrane * stretched * stretched +
                                               bending * curvature * curvature)),
                1.0, 1e-9);
  }
}

TEST(ElementEnergies, OfAMotionAreWhereItIs)
{
  const mesh::Mesh mesh = two_section_plate();
  MatrixXd motions = MatrixXd::Zero(6 * mesh.n_nodes(), 1);
  motions(0, 0) = 1e-3;  // a corner
  const MatrixXd energies = element_energies(mesh, structure, motions, PETSC_COMM_WORLD);
  EXPECT_GT(energies(0, 0), 0.0);
  EXPECT_EQ(energies.bottomRows(5).cwiseAbs().maxCoeff(), 0.0);
}

}  // namespace
}  // namespace chladni::plate
