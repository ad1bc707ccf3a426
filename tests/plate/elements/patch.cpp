#include "patch.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "plate/elements/shell_element.hpp"
#include "sample_elements.hpp"

namespace chladni::plate::testing {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using mesh::Shape;

/// 4 x 3 vertices; the two inner ones and those inside the edges are displaced.
Vector2d vertex(int i, int j)
{
  const double dx = (i == 1 && j == 1) ? 0.25 : (i == 2 && j == 1) ? -0.2 : (i == 1) ? -0.15 : 0.0;
  const double dy = (i == 1 && j == 1) ? 0.2 : (i == 2 && j == 1) ? -0.25 : 0.0;
  return {i + (i == 3 ? 0.0 : dx), j + dy};
}

std::vector<std::vector<Vector2d>> corners_of_elements(Shape shape)
{
  std::vector<std::vector<Vector2d>> elements;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 3; ++i) {
      const Vector2d a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                     d = vertex(i, j + 1);
      if (shape == Shape::quadrilateral) {
        elements.push_back({a, b, c, d});
      } else {
        elements.push_back({a, b, c});
        elements.push_back({a, c, d});
      }
    }
  }
  return elements;
}

Vector2d map_point(Shape shape, const std::vector<Vector2d>& x, const Vector2d& P)
{
  if (shape == Shape::triangle) return x[0] + P[0] * (x[1] - x[0]) + P[1] * (x[2] - x[0]);
  const double r = P[0], s = P[1];
  return 0.25 * ((1 - r) * (1 - s) * x[0] + (1 + r) * (1 - s) * x[1] + (1 + r) * (1 + s) * x[2] +
                 (1 - r) * (1 + s) * x[3]);
}

}  // namespace

Patch make_patch(Shape shape, int order)
{
  const auto elements = corners_of_elements(shape);
  const Eigen::MatrixX2d P = lattice(shape, order);
  Patch patch;
  std::map<std::pair<long, long>, int> index;
  std::vector<std::vector<int>> connectivity;
  for (const auto& corners : elements) {
    connectivity.emplace_back();
    for (Index k = 0; k < P.rows(); ++k) {
      const Vector2d x = map_point(shape, corners, P.row(k));
      const auto key = std::pair(std::lround(1e9 * x[0]), std::lround(1e9 * x[1]));
      const auto [it, is_new] = index.emplace(key, static_cast<int>(patch.positions.size()));
      if (is_new) patch.positions.push_back(x);
      connectivity.back().push_back(it->second);
    }
  }
  const auto n = static_cast<Index>(6 * patch.positions.size());
  patch.K = MatrixXd::Zero(n, n);
  for (const auto& nodes : connectivity) {
    ShellNodes shell{.x = NodeVectors::Zero(P.rows(), 3), .D = NodeVectors::Zero(P.rows(), 3)};
    for (Index k = 0; k < P.rows(); ++k) shell.x.row(k).head<2>() = patch.positions[nodes[k]];
    shell.D.col(2).setConstant(patch_thickness / 2);
    const MatrixXd K_e = shell_matrices(shape, order, shell, steel_like).K;
    for (Index a = 0; a < P.rows(); ++a)
      for (Index b = 0; b < P.rows(); ++b)
        patch.K.block<6, 6>(6 * nodes[a], 6 * nodes[b]) += K_e.block<6, 6>(6 * a, 6 * b);
  }
  return patch;
}

double patch_error(const Patch& patch, const Field& exact)
{
  VectorXd u(patch.K.rows());
  std::vector<Index> inner, outer;
  for (std::size_t i = 0; i < patch.positions.size(); ++i) {
    const Vector2d& x = patch.positions[i];
    u.segment<6>(6 * static_cast<Index>(i)) = exact(x);
    const bool boundary = x[0] < 1e-9 || x[0] > 3 - 1e-9 || x[1] < 1e-9 || x[1] > 2 - 1e-9;
    for (Index c = 0; c < 6; ++c)
      (boundary ? outer : inner).push_back(6 * static_cast<Index>(i) + c);
  }
  const VectorXd force = patch.K(inner, outer) * u(outer);
  const VectorXd solution = -patch.K(inner, inner).ldlt().solve(force);
  return (solution - u(inner)).cwiseAbs().maxCoeff() / u.cwiseAbs().maxCoeff();
}

std::vector<std::pair<Shape, int>> patch_elements()
{
  return {{Shape::quadrilateral, 1}, {Shape::quadrilateral, 2}, {Shape::quadrilateral, 3},
          {Shape::quadrilateral, 4}, {Shape::triangle, 1},      {Shape::triangle, 2},
          {Shape::triangle, 3}};
}

Eigen::Vector<double, 6> constant_membrane_strain(const Vector2d& x)
{
  Eigen::Vector<double, 6> u = Eigen::Vector<double, 6>::Zero();
  u[0] = 1e-3 * (x[0] + x[1] / 2);
  u[1] = 1e-3 * (x[1] + x[0] / 2);
  return u;
}

Eigen::Vector<double, 6> constant_curvature(const Vector2d& x)
{
  Eigen::Vector<double, 6> u = Eigen::Vector<double, 6>::Zero();
  u[2] = 0.5e-3 * (x[0] * x[0] + x[0] * x[1] + x[1] * x[1]);
  u[3] = 1e-3 * (x[0] / 2 + x[1]);   // theta_x = w_,y
  u[4] = -1e-3 * (x[0] + x[1] / 2);  // theta_y = -w_,x
  return u;
}

}  // namespace chladni::plate::testing
