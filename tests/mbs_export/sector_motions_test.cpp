#include "mbs_export/reduced_system.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace chladni::mbs_export {
namespace {

using Eigen::MatrixXd;

/// Of one node at (1, 0, 0) in each of six sectors: radial motion of one nodal diameter, and all of
/// them along the axis.
SectorMotions six_nodes()
{
  SectorMotions motions{.n_sectors = 6, .n_coordinates = 3, .harmonics = {}};
  motions.harmonics.push_back(
      {.order = 0, .x = MatrixXd::Zero(3, 1), .y = MatrixXd::Zero(3, 1), .columns = {1}});
  motions.harmonics.back().x(2, 0) = 1.0;
  motions.harmonics.push_back(
      {.order = 1, .x = MatrixXd::Zero(3, 2), .y = MatrixXd::Zero(3, 2), .columns = {0, 2}});
  motions.harmonics.back().x(0, 0) = 1.0;   // cos phi
  motions.harmonics.back().y(0, 1) = -1.0;  // sin phi
  return motions;
}

/// Along and about the axis of one diameter, as in six_nodes().
MatrixXd expected_of_sector(int j)
{
  const double phi = std::numbers::pi * j / 3.0;
  MatrixXd rows = MatrixXd::Zero(3, 3);
  rows.col(0) << std::cos(phi) * std::cos(phi), std::cos(phi) * std::sin(phi), 0.0;
  rows.col(1) << 0.0, 0.0, 1.0;
  rows.col(2) << std::sin(phi) * std::cos(phi), std::sin(phi) * std::sin(phi), 0.0;
  return rows;
}

TEST(SectorMotions, TurnWithTheSectorsInTheirPhases)
{
  const MatrixXd whole = in_coordinates(six_nodes(), MatrixXd::Identity(3, 3));
  ASSERT_EQ(whole.rows(), 18);
  for (int j = 0; j < 6; ++j)
    EXPECT_LT((whole.middleRows(3 * j, 3) - expected_of_sector(j)).norm(), 1e-15) << j;
}

TEST(SectorMotions, InOtherCoordinatesAreTheRowsTimesThese)
{
  const MatrixXd T = MatrixXd::Random(3, 4);
  const MatrixXd whole = in_coordinates(six_nodes(), T);
  for (int j = 0; j < 6; ++j)
    EXPECT_LT((whole.middleRows(3 * j, 3) - expected_of_sector(j) * T).norm(), 1e-15) << j;
}

TEST(SectorMotions, OfCoordinatesThatOthersCombine)
{
  const MatrixXd T = MatrixXd::Random(3, 3);
  SectorMotions motions = six_nodes();
  motions.T = T;
  const MatrixXd whole = in_coordinates(motions, MatrixXd::Identity(3, 3));
  for (int j = 0; j < 6; ++j)
    EXPECT_LT((whole.middleRows(3 * j, 3) - expected_of_sector(j) * T).norm(), 1e-15) << j;
}

}  // namespace
}  // namespace chladni::mbs_export
