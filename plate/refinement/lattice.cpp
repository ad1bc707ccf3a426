#include "plate/refinement/lattice.hpp"

namespace chladni::plate {
namespace {

using Eigen::Index, Eigen::RowVector2d, Eigen::VectorXd;
using mesh::Shape;

/// A point between the four corners of a part of a quadrilateral.
RowVector2d between(const std::array<RowVector2d, 4>& corners, double u, double v)
{
  return (1.0 - u) * ((1.0 - v) * corners[0] + v * corners[2]) +
         u * ((1.0 - v) * corners[1] + v * corners[3]);
}

/// The corners of the 2 x 2 parts of a quadrilateral, xi fastest.
std::array<std::array<RowVector2d, 3>, 3> corners_of_quarters(const Cuts& cuts)
{
  const auto [low, left, right, high] = cuts;
  // Where the lines between opposite cuts meet.
  const double r = (low + (high - low) * left) / (1.0 - (high - low) * (right - left));
  const double s = left + (right - left) * r;
  return {{{RowVector2d(0.0, 0.0), RowVector2d(low, 0.0), RowVector2d(1.0, 0.0)},
           {RowVector2d(0.0, left), RowVector2d(r, s), RowVector2d(1.0, right)},
           {RowVector2d(0.0, 1.0), RowVector2d(high, 1.0), RowVector2d(1.0, 1.0)}}};
}

RowVector2d in_quarters(int i, int j, int q, const Cuts& cuts)
{
  const auto corners = corners_of_quarters(cuts);
  const int column = i > q ? 1 : 0, row = j > q ? 1 : 0;
  const auto& below = corners.at(static_cast<std::size_t>(row));
  const auto& above = corners.at(static_cast<std::size_t>(row) + 1);
  const auto c = static_cast<std::size_t>(column);
  return between({below.at(c), below.at(c + 1), above.at(c), above.at(c + 1)},
                 double(i - column * q) / q, double(j - row * q) / q);
}

/// Of the four triangles between corners and cuts.
RowVector2d in_triangles(int i, int j, int q, const Cuts& cuts)
{
  const RowVector2d corner(0.0, 0.0), first(1.0, 0.0), second(0.0, 1.0);
  const RowVector2d on_r(cuts[0], 0.0), on_s(0.0, cuts[1]), across(1.0 - cuts[2], cuts[2]);
  const auto point = [&](const RowVector2d& from, const RowVector2d& a, const RowVector2d& b, int m,
                         int n) -> RowVector2d {
    return from + double(m) / q * (a - from) + double(n) / q * (b - from);
  };
  if (i + j <= q) return point(corner, on_r, on_s, i, j);
  if (i >= q) return point(on_r, first, across, i - q, j);
  if (j >= q) return point(on_s, across, second, i, j - q);
  return point(across, on_s, on_r, q - i, q - j);
}

RowVector2d parameters_of(const Lattice& lattice, int i, int j, int parts, const Cuts& cuts)
{
  const int q = lattice.n() / 2;
  if (parts == 1 || cuts == in_the_middle)
    return {double(i) / lattice.n(), double(j) / lattice.n()};
  if (lattice.shape() == Shape::triangle) return in_triangles(i, j, q, cuts);
  return in_quarters(i, j, q, cuts);
}

}  // namespace

int Lattice::size() const
{
  switch (shape_) {
    case Shape::line:
      return n_ + 1;
    case Shape::triangle:
      return (n_ + 1) * (n_ + 2) / 2;
    case Shape::quadrilateral:
      break;
  }
  return (n_ + 1) * (n_ + 1);
}

int Lattice::place(int i, int j) const
{
  if (shape_ == Shape::triangle) return j * (n_ + 1) - j * (j - 1) / 2 + i;
  return j * (n_ + 1) + i;
}

std::vector<std::vector<int>> Lattice::edges() const
{
  const bool is_line = shape_ == Shape::line, is_triangle = shape_ == Shape::triangle;
  std::vector<std::vector<int>> edges(is_line ? 1 : is_triangle ? 3 : 4);
  for (int i = 0; i <= n_; ++i) {
    edges[0].push_back(place(i, 0));
    if (is_line) continue;
    edges[1].push_back(place(0, i));
    edges[2].push_back(is_triangle ? place(n_ - i, i) : place(n_, i));
    if (!is_triangle) edges[3].push_back(place(i, n_));
  }
  return edges;
}

std::vector<std::array<double, 2>> lattice_parameters(const Lattice& lattice, int parts,
                                                      const Cuts& cuts)
{
  std::vector<std::array<double, 2>> parameters(static_cast<std::size_t>(lattice.size()));
  for (int j = 0; j < lattice.n_rows(); ++j) {
    for (int i = 0; i < lattice.n_columns(j); ++i) {
      const RowVector2d at = parameters_of(lattice, i, j, parts, cuts);
      parameters[static_cast<std::size_t>(lattice.place(i, j))] = {at[0], at[1]};
    }
  }
  return parameters;
}

std::vector<Part> parts_of(Shape shape, int parts)
{
  std::vector<Part> all;
  for (int j = 0; j < (shape == Shape::line ? 1 : parts); ++j) {
    for (int i = 0; i < (shape == Shape::triangle ? parts - j : parts); ++i) {
      all.push_back({.i = i, .j = j, .sign = 1});
      // The triangle between three others is turned by half a turn.
      if (shape == Shape::triangle && i + j + 2 <= parts)
        all.push_back({.i = i + 1, .j = j + 1, .sign = -1});
    }
  }
  return all;
}

Eigen::MatrixXd shapes_at(Shape shape, int order,
                          const std::vector<std::array<double, 2>>& parameters)
{
  const Index n = std::ssize(parameters);
  Points points{.xi = VectorXd(n), .eta = VectorXd(n), .weight = {}};
  for (Index k = 0; k < n; ++k) {
    const auto& [r, s] = parameters[static_cast<std::size_t>(k)];
    points.xi[k] = shape == Shape::triangle ? r : 2.0 * r - 1.0;
    points.eta[k] = shape == Shape::triangle ? s : 2.0 * s - 1.0;
  }
  if (shape == Shape::line) return lagrange(VectorXd::LinSpaced(order + 1, -1.0, 1.0), points.xi);
  return lagrange_basis(shape, order, points).N;
}

}  // namespace chladni::plate
