#include "plate/elements/mass_points.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <utility>

#include "plate/elements/shell_strains.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

MassPoints empty_points(Index n_points, Index n_nodes)
{
  MassPoints points{.dm = Eigen::VectorXd(n_points), .x = NodeVectors(n_points, 3), .N = {}};
  points.N.fill(StrainRows::Zero(n_points, 6 * n_nodes));
  return points;
}

/// theta x r = S theta.
Matrix3d arm_rotation_to_displacement(const Vector3d& r)
{
  Matrix3d S;
  S << 0.0, r.z(), -r.y(), -r.z(), 0.0, r.x(), r.y(), -r.x(), 0.0;
  return S;
}

struct ShellRule {
  Points points;
  Basis basis;
};

const ShellRule& shell_rule(mesh::Shape shape, int order)
{
  static std::map<std::pair<mesh::Shape, int>, ShellRule> cache;
  const std::pair key{shape, order};
  const auto it = cache.find(key);
  if (it != cache.end()) return it->second;
  const Points points = gauss_points(shape, order + 1);
  return cache.emplace(key, ShellRule{points, lagrange_basis(shape, order, points)}).first->second;
}

/// Displacement of the point (y, z) of a section in the local axes, from its mean displacement and
/// rotation (u, theta), [3 x 6].
Eigen::Matrix<double, 3, 6> section_displacement(double y, double z, bool has_rotary_inertia)
{
  Eigen::Matrix<double, 3, 6> R;
  R << Matrix3d::Identity(), arm_rotation_to_displacement({0.0, y, z});
  if (!has_rotary_inertia) R.rightCols<2>().setZero();
  return R;
}

}  // namespace

MassPoints shell_mass_points(mesh::Shape shape, int order, const ShellNodes& nodes, double density)
{
  const auto& [rule, basis] = shell_rule(shape, order);
  const ShellFrame frame = shell_frame(basis, nodes);
  MassPoints points = empty_points(rule.size() * std::ssize(thickness_points), nodes.x.rows());
  const Eigen::VectorXd weight = density * rule.weight.cwiseProduct(leaning(basis, nodes));
  Index p = 0;
  for (const double zeta : thickness_points) {
    const NodeVectors x = nodes.x + zeta * nodes.D;
    for (Index q = 0; q < rule.size(); ++q, ++p) {
      points.dm[p] = weight[q] * volume_element(frame, q, zeta);
      points.x.row(p) = basis.N.row(q) * x;
      // u = sum N_i (u_i + zeta theta_i x D_i)
      for (Index i = 0; i < nodes.x.rows(); ++i) {
        const Matrix3d S = zeta * arm_rotation_to_displacement(nodes.D.row(i).transpose());
        for (std::size_t c = 0; c < 3; ++c) {
          points.N[c](p, 6 * i + Index(c)) = basis.N(q, i);
          points.N[c].row(p).segment<3>(6 * i + 3) = basis.N(q, i) * S.row(Index(c));
        }
      }
    }
  }
  return points;
}

MassPoints beam_mass_points(const NodeVectors& x, const BeamSection& section, LineFields fields)
{
  const double y = std::sqrt(section.I_z / section.area), z = std::sqrt(section.I_y / section.area);
  const std::array<std::pair<double, double>, 4> section_points{
      {{y, z}, {y, -z}, {-y, z}, {-y, -z}}};
  const std::vector<AxisPoint> axis = beam_fields(x, section, fields).moved;
  MassPoints points = empty_points(4 * std::ssize(axis), x.rows());
  Index p = 0;
  for (const AxisPoint& at : axis) {
    for (const auto& [y_p, z_p] : section_points) {
      const MatrixXd u = at.axes.transpose() *
                         section_displacement(y_p, z_p, section.has_rotary_inertia) * at.motion;
      points.dm[p] = section.material.density * section.area * at.length / 4.0;
      points.x.row(p) = at.x + y_p * at.axes.row(1) + z_p * at.axes.row(2);
      for (std::size_t c = 0; c < 3; ++c) points.N[c].row(p) = u.row(Index(c));
      ++p;
    }
  }
  return points;
}

MassPoints rigid_mass_points(const PointMass& mass, const Vector3d& node)
{
  const auto [xx, yy, zz, xy, xz, yz] = mass.inertia;
  Matrix3d J;
  J << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  // int r r^T dm from the inertia; each principal axis has two points at -+1 m that weigh half of
  // its moment, and the centre weighs what these leave.
  const Matrix3d moment = 0.5 * J.trace() * Matrix3d::Identity() - J;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(moment);
  const Vector3d centre(mass.offset.data());
  MassPoints points = empty_points(7, 1);
  points.dm[0] = mass.mass - principal.eigenvalues().sum();
  points.x.row(0) = centre;
  for (Index k = 0; k < 3; ++k) {
    points.dm.segment<2>(1 + 2 * k).setConstant(0.5 * principal.eigenvalues()[k]);
    points.x.row(1 + 2 * k) = centre + principal.eigenvectors().col(k);
    points.x.row(2 + 2 * k) = centre - principal.eigenvectors().col(k);
  }
  for (Index p = 0; p < 7; ++p) {
    const Matrix3d S = arm_rotation_to_displacement(points.x.row(p).transpose());
    for (std::size_t c = 0; c < 3; ++c) {
      points.N[c](p, Index(c)) = 1.0;
      points.N[c].row(p).segment<3>(3) = S.row(Index(c));
    }
  }
  points.x.rowwise() += node.transpose();
  return points;
}

}  // namespace chladni::plate
