#include "mesh/node_grid.hpp"

#include <cmath>

namespace chladni::mesh {

NodeGrid::NodeGrid(std::span<const std::array<double, 3>> points, double tolerance)
    : points_(points), tolerance_(tolerance)
{
  for (std::size_t i = 0; i < points_.size(); ++i)
    cells_[cell(points_[i])].push_back(static_cast<int>(i));
}

int NodeGrid::near(const std::array<double, 3>& x) const
{
  const Cell home = cell(x);
  int nearest = -1;
  double least = tolerance_;
  for (int i = 0; i < 27; ++i) {
    const auto found =
        cells_.find({home[0] + i % 3 - 1, home[1] + i / 3 % 3 - 1, home[2] + i / 9 - 1});
    if (found == cells_.end()) continue;
    for (const int point : found->second) {
      const auto& y = points_[std::size_t(point)];
      const double d = std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
      if (d > least) continue;
      least = d;
      nearest = point;
    }
  }
  return nearest;
}

NodeGrid::Cell NodeGrid::cell(const std::array<double, 3>& x) const
{
  return {std::int64_t(std::floor(x[0] / tolerance_)), std::int64_t(std::floor(x[1] / tolerance_)),
          std::int64_t(std::floor(x[2] / tolerance_))};
}

}  // namespace chladni::mesh
