#include "serendipity.hpp"

#include <Eigen/Geometry>
#include <array>

#include "plate/elements/shell_strains.hpp"

namespace chladni::benchmarks {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using plate::Basis;
using plate::Points;

plate::Basis eight_nodes(const Points& points)
{
  constexpr std::array<std::pair<int, int>, 8> lattice{
      {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
  const Eigen::ArrayXd X = points.xi, Y = points.eta;
  Basis basis{
      .N = MatrixXd(X.size(), 8), .N_xi = MatrixXd(X.size(), 8), .N_eta = MatrixXd(X.size(), 8)};
  for (Index i = 0; i < 8; ++i) {
    const auto [a, b] = lattice[i];
    if (a != 0 && b != 0) {
      basis.N.col(i) = 0.25 * (1 + a * X) * (1 + b * Y) * (a * X + b * Y - 1);
      basis.N_xi.col(i) = 0.25 * a * (1 + b * Y) * (2 * a * X + b * Y);
      basis.N_eta.col(i) = 0.25 * b * (1 + a * X) * (2 * b * Y + a * X);
    } else if (a == 0) {
      basis.N.col(i) = 0.5 * (1 - X * X) * (1 + b * Y);
      basis.N_xi.col(i) = -X * (1 + b * Y);
      basis.N_eta.col(i) = 0.5 * b * (1 - X * X);
    } else {
      basis.N.col(i) = 0.5 * (1 + a * X) * (1 - Y * Y);
      basis.N_xi.col(i) = 0.5 * a * (1 - Y * Y);
      basis.N_eta.col(i) = -Y * (1 + a * X);
    }
  }
  return basis;
}

Basis basis_of(mesh::Shape shape, const Points& points)
{
  return shape == mesh::Shape::triangle ? plate::lagrange_basis(shape, 2, points)
                                        : eight_nodes(points);
}

Points reduced_points(mesh::Shape shape)
{
  if (shape != mesh::Shape::triangle) return plate::gauss_points(shape, 2);
  Points points{.xi = Eigen::VectorXd(3), .eta = Eigen::VectorXd(3), .weight = {}};
  points.xi << 1.0 / 6, 2.0 / 3, 1.0 / 6;
  points.eta << 1.0 / 6, 1.0 / 6, 2.0 / 3;
  points.weight = Eigen::VectorXd::Constant(3, 1.0 / 6);
  return points;
}

MatrixXd mass(const Basis& basis, const plate::ShellNodes& nodes, const Points& points,
              double density)
{
  const plate::ShellFrame frame = plate::shell_frame(basis, nodes);
  const Index n = nodes.x.rows();
  plate::StrainRows H = plate::StrainRows::Zero(6 * points.size(), 6 * n);
  Index row = 0;
  for (const double zeta : plate::thickness_points) {
    for (Index q = 0; q < points.size(); ++q, row += 3) {
      const double m = density * points.weight[q] * plate::volume_element(frame, q, zeta);
      for (Index i = 0; i < n; ++i) {
        const double N = std::sqrt(m) * basis.N(q, i);
        const Eigen::Vector3d D = zeta * nodes.D.row(i).transpose();
        for (int c = 0; c < 3; ++c) {
          H(row + c, 6 * i + c) = N;
          H.block<3, 1>(row, 6 * i + 3 + c) = N * Eigen::Vector3d::Unit(c).cross(D);
        }
      }
    }
  }
  return plate::gram_matrix(H);
}

}  // namespace

std::vector<int> serendipity_places(mesh::Shape shape)
{
  if (shape == mesh::Shape::triangle) return {0, 1, 2, 3, 4, 5};
  return {0, 1, 2, 3, 5, 6, 7, 8};
}

plate::ElementMatrices serendipity_matrices(mesh::Shape shape, const plate::ShellNodes& nodes,
                                            const plate::Material& material)
{
  const Points reduced = reduced_points(shape), full = plate::gauss_points(shape, 3);
  const Basis basis = basis_of(shape, reduced);
  return {.K = plate::stiffness(plate::covariant_strains(basis, nodes),
                                plate::shell_frame(basis, nodes), reduced,
                                plate::elasticity_root(material, plate::Strains::all)),
          .M = mass(basis_of(shape, full), nodes, full, material.density)};
}

}  // namespace chladni::benchmarks
