#include "mbs_export/sector_motions.hpp"

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

TEST(SectorMotions, TurnWithTheSectorsInTheirPhases)
{
  for (int j = 0; j < 6; ++j) {
    const double phi = std::numbers::pi * j / 3.0;
    MatrixXd expected = MatrixXd::Zero(3, 3);
    expected.col(0) << std::cos(phi) * std::cos(phi), std::cos(phi) * std::sin(phi), 0.0;
    expected.col(1) << 0.0, 0.0, 1.0;
    expected.col(2) << std::sin(phi) * std::cos(phi), std::sin(phi) * std::sin(phi), 0.0;
    EXPECT_LT((rows_of_sector(six_nodes(), j) - expected).norm(), 1e-15) << j;
  }
}

TEST(SectorMotions, InOtherCoordinatesAreTheRowsTimesThese)
{
  const MatrixXd T = MatrixXd::Random(3, 4);
  const MatrixXd whole = in_coordinates(six_nodes(), T);
  ASSERT_EQ(whole.rows(), 18);
  for (int j = 0; j < 6; ++j) {
    const MatrixXd expected = rows_of_sector(six_nodes(), j) * T;
    EXPECT_LT((whole.middleRows(3 * j, 3) - expected).norm(), 1e-15) << j;
  }
}

}  // namespace
}  // namespace chladni::mbs_export
