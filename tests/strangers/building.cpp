#include "building.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace chladni::strangers {

using Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d;

void add(std::vector<Entry>& A, std::span<const int> dofs, const MatrixXd& block)
{
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    for (std::size_t j = 0; j < dofs.size(); ++j) {
      const double value = block(static_cast<int>(i), static_cast<int>(j));
      if (dofs[i] >= 0 && dofs[j] >= 0 && value != 0.0) A.push_back({dofs[i], dofs[j], value});
    }
  }
}

void add_spring(std::vector<Entry>& K, int i, int j, double k)
{
  const std::array<int, 2> ends{i, j};
  add(K, ends, (MatrixXd(2, 2) << k, -k, -k, k).finished());
}

void add_diagonal(std::vector<Entry>& A, int i, double value)
{
  A.push_back({i, i, value});
}

void add_identity(std::vector<Entry>& A, int n, double value)
{
  for (int i = 0; i < n; ++i) add_diagonal(A, i, value);
}

void scale(std::vector<Entry>& A, double factor)
{
  for (Entry& entry : A) entry.value *= factor;
}

ElementMatrices beam_element(double length, double bending_stiffness, double mass_per_length)
{
  const double l = length;
  MatrixXd K(4, 4), M(4, 4);
  K << 12, 6 * l, -12, 6 * l, 6 * l, 4 * l * l, -6 * l, 2 * l * l, -12, -6 * l, 12, -6 * l, 6 * l,
      2 * l * l, -6 * l, 4 * l * l;
  M << 156, 22 * l, 54, -13 * l, 22 * l, 4 * l * l, 13 * l, -3 * l * l, 54, 13 * l, 156, -22 * l,
      -13 * l, -3 * l * l, -22 * l, 4 * l * l;
  return {.K = K * (bending_stiffness / (l * l * l)), .M = M * (mass_per_length * l / 420.0)};
}

namespace {

/// Adds a 2 x 2 form of the displacements or rotations `c` of both ends.
void add_line(MatrixXd& A, int c, double diagonal, double other)
{
  A(c, c) += diagonal;
  A(c + 6, c + 6) += diagonal;
  A(c, c + 6) += other;
  A(c + 6, c) += other;
}

/// Adds the bending of displacement `u` and rotation `r`; a slope is r or -r.
void add_bending(MatrixXd& A, const MatrixXd& B, int u, int r, double slope)
{
  const std::array<int, 4> at{u, r, u + 6, r + 6};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      A(at[i], at[j]) += B(i, j) * (i % 2 == 1 ? slope : 1.0) * (j % 2 == 1 ? slope : 1.0);
}

/// Rows: the axes of a rod, the first along it.
Matrix3d axes_of(const Vector3d& along)
{
  const Vector3d x = along.normalized();
  const Vector3d other = std::abs(x.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitY();
  const Vector3d y = other.cross(x).normalized();
  Matrix3d axes;
  axes << x.transpose(), y.transpose(), x.cross(y).transpose();
  return axes;
}

}  // namespace

ElementMatrices frame_element(const Vector3d& a, const Vector3d& b, const FrameSection& section)
{
  const double l = (b - a).norm(), m = section.density * section.area;
  MatrixXd K = MatrixXd::Zero(12, 12), M = K;
  add_line(K, 0, section.young * section.area / l, -section.young * section.area / l);
  add_line(K, 3, section.shear * section.torsion / l, -section.shear * section.torsion / l);
  const double polar = section.density * (section.inertia_y + section.inertia_z) * l;
  add_line(M, 0, m * l / 3.0, m * l / 6.0);
  add_line(M, 3, polar / 3.0, polar / 6.0);
  const ElementMatrices about_z = beam_element(l, section.young * section.inertia_z, m);
  const ElementMatrices about_y = beam_element(l, section.young * section.inertia_y, m);
  add_bending(K, about_z.K, 1, 5, 1.0);
  add_bending(M, about_z.M, 1, 5, 1.0);
  add_bending(K, about_y.K, 2, 4, -1.0);
  add_bending(M, about_y.M, 2, 4, -1.0);
  MatrixXd T = MatrixXd::Zero(12, 12);
  for (int i = 0; i < 4; ++i) T.block<3, 3>(3 * i, 3 * i) = axes_of(b - a);
  return {.K = T.transpose() * K * T, .M = T.transpose() * M * T};
}

namespace {

/// Signs of the corners of a hexahedron, x fastest.
Vector3d corner(int i)
{
  return {i % 2 == 0 ? -1.0 : 1.0, i / 2 % 2 == 0 ? -1.0 : 1.0, i / 4 == 0 ? -1.0 : 1.0};
}

Eigen::Matrix<double, 6, 6> elasticity(const Solid& solid)
{
  const double mu = solid.young / (2.0 * (1.0 + solid.poisson));
  const double lame =
      solid.young * solid.poisson / ((1.0 + solid.poisson) * (1.0 - 2.0 * solid.poisson));
  Eigen::Matrix<double, 6, 6> C = Eigen::Matrix<double, 6, 6>::Zero();
  C.topLeftCorner<3, 3>().setConstant(lame);
  for (int i = 0; i < 3; ++i) {
    C(i, i) += 2.0 * mu;
    C(i + 3, i + 3) = mu;
  }
  return C;
}

/// Strains xx yy zz xy yz zx of the displacements at a point of the unit cube.
MatrixXd strains(const Vector3d& xi, const Vector3d& edges)
{
  MatrixXd B = MatrixXd::Zero(6, 24);
  for (int i = 0; i < 8; ++i) {
    const Vector3d s = corner(i), f = Vector3d::Ones() + s.cwiseProduct(xi);
    const Vector3d g(s.x() * f.y() * f.z() / (4.0 * edges.x()),
                     s.y() * f.x() * f.z() / (4.0 * edges.y()),
                     s.z() * f.x() * f.y() / (4.0 * edges.z()));
    for (int c = 0; c < 3; ++c) {
      B(c, 3 * i + c) = g[c];
      B(3 + c, 3 * i + c) = g[(c + 1) % 3];
      B(3 + c, 3 * i + (c + 1) % 3) = g[c];
    }
  }
  return B;
}

}  // namespace

ElementMatrices hexahedron(const Vector3d& edges, const Solid& solid)
{
  ElementMatrices e{.K = MatrixXd::Zero(24, 24), .M = MatrixXd::Zero(24, 24)};
  const double dV = edges.prod() / 8.0;
  const Eigen::Matrix<double, 6, 6> C = elasticity(solid);
  for (int p = 0; p < 8; ++p) {
    const Vector3d xi = corner(p) / std::sqrt(3.0);
    const MatrixXd B = strains(xi, edges);
    e.K += dV * B.transpose() * C * B;
    MatrixXd N = MatrixXd::Zero(3, 24);
    for (int i = 0; i < 8; ++i) {
      const Vector3d f = Vector3d::Ones() + corner(i).cwiseProduct(xi);
      for (int c = 0; c < 3; ++c) N(c, 3 * i + c) = f.prod() / 8.0;
    }
    e.M += dV * solid.density * N.transpose() * N;
  }
  return e;
}

}  // namespace chladni::strangers
