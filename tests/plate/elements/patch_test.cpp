#include "patch.hpp"

#include <gtest/gtest.h>

namespace chladni::plate {
namespace {

using Eigen::Vector2d;
using mesh::Shape;
using testing::patch_error;

class PatchOf : public ::testing::TestWithParam<std::pair<Shape, int>> {
 protected:
  testing::Patch patch() const { return testing::make_patch(GetParam().first, GetParam().second); }
};

// Round-off of a system whose stiffnesses span (h / t)^2 / drilling factor ~ 1e7.
constexpr double tolerance = 1e-10;

TEST_P(PatchOf, ReproducesConstantMembraneStrain)
{
  EXPECT_LT(patch_error(patch(), testing::constant_membrane_strain), tolerance);
}

TEST_P(PatchOf, ReproducesConstantCurvatureAndTwist)
{
  EXPECT_LT(patch_error(patch(), testing::constant_curvature), tolerance);
}

TEST_P(PatchOf, ReproducesConstantShearInThePlane)
{
  const testing::Field exact = [](const Vector2d& x) {
    Eigen::Matrix<double, 6, 1> u = Eigen::Matrix<double, 6, 1>::Zero();
    u[0] = 1e-3 * x[1];
    u[5] = -0.5e-3;  // drilling follows the curl
    return u;
  };
  EXPECT_LT(patch_error(patch(), exact), tolerance);
}

TEST_P(PatchOf, ReproducesConstantTwist)
{
  const testing::Field exact = [](const Vector2d& x) {
    Eigen::Matrix<double, 6, 1> u = Eigen::Matrix<double, 6, 1>::Zero();
    u[2] = 1e-3 * x[0] * x[1];
    u[3] = 1e-3 * x[0];
    u[4] = -1e-3 * x[1];
    return u;
  };
  EXPECT_LT(patch_error(patch(), exact), tolerance);
}

INSTANTIATE_TEST_SUITE_P(
    ShapesAndOrders, PatchOf,
    ::testing::Values(std::pair{Shape::quadrilateral, 1}, std::pair{Shape::quadrilateral, 2},
                      std::pair{Shape::quadrilateral, 3}, std::pair{Shape::quadrilateral, 4},
                      std::pair{Shape::triangle, 1}, std::pair{Shape::triangle, 2},
                      std::pair{Shape::triangle, 3}));

}  // namespace
}  // namespace chladni::plate
