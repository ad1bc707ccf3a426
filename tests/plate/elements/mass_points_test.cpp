#include "plate/elements/mass_points.hpp"

#include <gtest/gtest.h>

#include "plate/elements/beam_element.hpp"
#include "sample_elements.hpp"
#include "tests/plate/beam_lines.hpp"

namespace chladni::plate {
namespace {

using Eigen::MatrixXd;
using mesh::Shape;

/// sum dm N^T N
MatrixXd mass_matrix(const MassPoints& points)
{
  MatrixXd M = MatrixXd::Zero(points.N[0].cols(), points.N[0].cols());
  for (const StrainRows& N : points.N) M += N.transpose() * points.dm.asDiagonal() * N;
  return M;
}

TEST(MassPoints, OfEachShellMakeItsMassMatrix)
{
  for (const auto& [shape, order] : {std::pair{Shape::quadrilateral, 1},
                                     {Shape::quadrilateral, 3},
                                     {Shape::triangle, 1},
                                     {Shape::triangle, 3}}) {
    const ShellNodes nodes = testing::curved_element(shape, order);
    const MatrixXd M = shell_matrices(shape, order, nodes, testing::steel_like).M;
    const MassPoints points = shell_mass_points(shape, order, nodes, testing::steel_like.density);
    EXPECT_LT((mass_matrix(points) - M).norm(), 1e-14 * M.norm());  // round-off
  }
}

TEST(MassPoints, OfBeamsMakeTheirMassMatrixWithAndWithoutRotaryInertia)
{
  NodeVectors curved(3, 3);
  curved << 0.0, 0.1, 0.2, 1.0, 0.4, 0.1, 1.5, 1.4, 0.3;
  const Eigen::RowVector3d end(1.5, 1.4, 0.3);
  for (const NodeVectors& x :
       {curved, testing::line({0, 0, 0}, end, 1), testing::line({0, 0, 0}, end, 2),
        testing::line({0, 0, 0}, end, 4)}) {
    for (const BeamTheory theory : {BeamTheory::bernoulli_euler, BeamTheory::timoshenko}) {
      for (const bool rotary : {true, false}) {
        const BeamSection section{.group = "beam",
                                  .material = testing::steel_like,
                                  .theory = theory,
                                  .area = 0.3,
                                  .I_y = 0.02,
                                  .I_z = 0.05,
                                  .J = 0.04,
                                  .has_rotary_inertia = rotary,
                                  .orientation = std::array{0.1, 0.3, 1.0}};
        const MatrixXd M = beam_matrices(x, section).M;
        EXPECT_LT((mass_matrix(beam_mass_points(x, section)) - M).norm(), 1e-14 * M.norm());
      }
    }
  }
}

}  // namespace
}  // namespace chladni::plate
