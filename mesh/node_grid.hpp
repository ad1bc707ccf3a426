#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace chladni::mesh {

/// Finds points by position, with a grid of cells as wide as a tolerance.
class NodeGrid {
 public:
  /// @param points     must outlive this object; m
  /// @param tolerance  m
  NodeGrid(std::span<const std::array<double, 3>> points, double tolerance);

  /// The index of the nearest point within the tolerance; -1 if there is none.
  int near(const std::array<double, 3>& x) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell(const std::array<double, 3>& x) const;

  std::span<const std::array<double, 3>> points_;
  double tolerance_;
  std::map<Cell, std::vector<int>> cells_;
};

}  // namespace chladni::mesh
