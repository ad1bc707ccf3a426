#include "mesh/tangents.hpp"

namespace chladni::mesh {

namespace {

struct ValueSlope {
  double value, slope;
};

/// Product of linear factors with its derivative.
ValueSlope times(const ValueSlope& a, const ValueSlope& b)
{
  return {a.value * b.value, a.slope * b.value + a.value * b.slope};
}

/// The Lagrange polynomial of lattice point k of 0..p on [0, 1].
ValueSlope lagrange(int p, int k, double x)
{
  ValueSlope product{1.0, 0.0};
  for (int m = 0; m <= p; ++m)
    if (m != k) product = times(product, {(p * x - m) / (k - m), double(p) / (k - m)});
  return product;
}

/// The factor of a triangle's shape functions that vanishes on the lattice lines below k.
ValueSlope below(int p, int k, double x)
{
  ValueSlope product{1.0, 0.0};
  for (int m = 0; m < k; ++m)
    product = times(product, {(p * x - m) / (m + 1), double(p) / (m + 1)});
  return product;
}

NodeDerivatives of_quadrilateral(int p)
{
  const int n = (p + 1) * (p + 1);
  NodeDerivatives d{.n_nodes = n, .first = {}, .second = {}};
  for (int i = 0; i < n; ++i) {
    const int row = i / (p + 1);
    const double r = double(i % (p + 1)) / p;
    const double s = double(row) / p;
    for (int j = 0; j < n; ++j) {
      const ValueSlope a = lagrange(p, j % (p + 1), r);
      const ValueSlope b = lagrange(p, j / (p + 1), s);
      d.first.push_back(a.slope * b.value);
      d.second.push_back(a.value * b.slope);
    }
  }
  return d;
}

/// Columns and rows of the lattice of a triangle in its order.
std::vector<std::array<int, 2>> triangle_lattice(int p)
{
  std::vector<std::array<int, 2>> lattice;
  for (int row = 0; row <= p; ++row)
    for (int column = 0; column <= p - row; ++column) lattice.push_back({column, row});
  return lattice;
}

NodeDerivatives of_triangle(int p)
{
  const auto lattice = triangle_lattice(p);
  NodeDerivatives d{.n_nodes = static_cast<int>(lattice.size()), .first = {}, .second = {}};
  for (const auto& [column, row] : lattice) {
    const double r = double(column) / p;
    const double s = double(row) / p;
    for (const auto& [k, l] : lattice) {
      const ValueSlope a = below(p, k, r);
      const ValueSlope b = below(p, l, s);
      const ValueSlope c = below(p, p - k - l, 1.0 - r - s);
      d.first.push_back((a.slope * c.value - a.value * c.slope) * b.value);
      d.second.push_back((b.slope * c.value - b.value * c.slope) * a.value);
    }
  }
  return d;
}

}  // namespace

NodeDerivatives node_derivatives(Shape shape, int order)
{
  return shape == Shape::triangle ? of_triangle(order) : of_quadrilateral(order);
}

}  // namespace chladni::mesh
