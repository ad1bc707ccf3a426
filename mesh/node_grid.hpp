#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace chladni::mesh {

/// Finds points by place, in cells as wide as a tolerance.
class NodeGrid {
 public:
  /// @param points  must outlive this
  NodeGrid(std::span<const std::array<double, 3>> points, double tolerance);

  /// The nearest point within the tolerance; -1 where none is.
  int near(const std::array<double, 3>& x) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell(const std::array<double, 3>& x) const;

  std::span<const std::array<double, 3>> points_;
  double tolerance_;
  std::map<Cell, std::vector<int>> cells_;
};

}  // namespace chladni::mesh
