#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::plate::testing {

struct ElementUnderTest {
  mesh::Shape shape;
  int order;
};

/// Every shell element.
inline std::vector<ElementUnderTest> elements_under_test()
{
  using enum mesh::Shape;
  return {{quadrilateral, 1}, {quadrilateral, 2}, {quadrilateral, 3}, {quadrilateral, 4},
          {triangle, 1},      {triangle, 2},      {triangle, 3}};
}

/// Grids of nearly the same number of nodes for all orders.
inline int elements_per_side(int order)
{
  return std::array{16, 8, 5, 4}[order - 1];
}

/// Allowed relative deviation from a target: of linear quadrilaterals, those of order 2 to 4,
/// linear triangles, those of order 2 and 3.
struct Allowed {
  double linear_quadrilateral, quadrilateral, linear_triangle, triangle;

  double of(const ElementUnderTest& element) const
  {
    if (element.shape == mesh::Shape::triangle)
      return element.order == 1 ? linear_triangle : triangle;
    return element.order == 1 ? linear_quadrilateral : quadrilateral;
  }
};

inline std::string element_name(const ::testing::TestParamInfo<ElementUnderTest>& info)
{
  return (info.param.shape == mesh::Shape::triangle ? "Triangle" : "Quadrilateral") +
         std::to_string(info.param.order);
}

}  // namespace chladni::plate::testing
