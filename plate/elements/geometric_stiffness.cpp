#include "plate/elements/geometric_stiffness.hpp"

#include <Eigen/Geometry>
#include <array>

#include "plate/elements/beam_element.hpp"
#include "plate/elements/element_rules.hpp"
#include "plate/elements/shell_resultants.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::RowVector3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Membrane forces at the points of a rule, [n_points x 6], as in ShellResultants.
MatrixXd membrane_forces(mesh::Shape shape, int order, const Basis& basis,
                         const ShellResultants& resultants)
{
  return basis.N * (extrapolation_to_nodes(shape, order) * resultants.N);
}

Matrix3d tensor(const Eigen::Matrix<double, 1, 6>& components)
{
  Matrix3d N;
  N << components[0], components[3], components[5],  //
      components[3], components[1], components[4],   //
      components[5], components[4], components[2];
  return N;
}

/// H_ij = int N^ab N_i,a N_j,b dA.
MatrixXd membrane_energy(const Rule& rule, const ShellFrame& frame, const MatrixXd& forces)
{
  const auto& [points, basis] = rule;
  MatrixXd H = MatrixXd::Zero(basis.N.cols(), basis.N.cols());
  for (Index q = 0; q < points.size(); ++q) {
    const Vector3d a_1 = frame.a_1.row(q), a_2 = frame.a_2.row(q);
    const Vector3d normal = a_1.cross(a_2);
    const double J = normal.norm();
    // a^1 and a^2, the gradients of the surface coordinates
    const Vector3d a1 = a_2.cross(normal) / (J * J), a2 = normal.cross(a_1) / (J * J);
    const Matrix3d N = tensor(forces.row(q));
    const auto along_1 = basis.N_xi.row(q), along_2 = basis.N_eta.row(q);
    const double weight = J * points.weight[q];
    const MatrixXd mixed = along_1.transpose() * along_2;
    H += weight * (a1.dot(N * a1) * along_1.transpose() * along_1 +
                   a2.dot(N * a2) * along_2.transpose() * along_2 +
                   a1.dot(N * a2) * (mixed + mixed.transpose()));
  }
  return H;
}

/// theta x D = S theta.
Matrix3d rotation_to_displacement(const Vector3d& D)
{
  Matrix3d S;
  S << 0.0, D.z(), -D.y(), -D.z(), 0.0, D.x(), D.y(), -D.x(), 0.0;
  return S;
}

using Shapes = Eigen::Matrix<double, 6, 12>;

/// d/dx of `beam_shapes`, which are cubic in xi: differences over a step h have an error c h^2 that
/// two steps cancel.
Shapes slopes_at(double xi, const RowVector3d& along, const BeamSection& section)
{
  const auto difference = [&](double h) -> Shapes {
    return (beam_shapes(xi + h, along, section) - beam_shapes(xi - h, along, section)) / (2.0 * h);
  };
  return (4.0 * difference(0.5) - difference(1.0)) / (3.0 * along.norm());
}

/// Of one beam, in the global axes, for an axial force of 1 N.
Eigen::Matrix<double, 12, 12> unit_beam(const RowVector3d& along, const BeamSection& section)
{
  // Slopes are of degree two: their squares need three points.
  static const GaussRule rule = gauss_legendre(3);
  const double r_z = section.I_z / section.area, r_y = section.I_y / section.area;
  // The local components u, v, w, phi, psi_y, psi_z: a turn about y moves points by z, about z by
  // y.
  const Eigen::Vector<double, 6> weights(1.0, 1.0, 1.0, r_y + r_z, r_y, r_z);
  Eigen::Matrix<double, 12, 12> K = Eigen::Matrix<double, 12, 12>::Zero();
  for (Index q = 0; q < rule.x.size(); ++q) {
    const Shapes slopes = slopes_at(0.5 * (1.0 + rule.x[q]), along, section);
    K += 0.5 * along.norm() * rule.w[q] * slopes.transpose() * weights.asDiagonal() * slopes;
  }
  return K;
}

}  // namespace

MatrixXd shell_geometric_stiffness(mesh::Shape shape, int order, const ShellNodes& nodes,
                                   const Material& material, const VectorXd& u_e)
{
  const ShellResultants resultants = shell_resultants(shape, order, nodes, material, u_e);
  const Rule& rule = rules_of(shape, order).full;
  const MatrixXd H = membrane_energy(rule, shell_frame(rule.basis, nodes),
                                     membrane_forces(shape, order, rule.basis, resultants));
  const Index n = nodes.x.rows();
  MatrixXd K = MatrixXd::Zero(6 * n, 6 * n);
  for (Index i = 0; i < n; ++i) {
    const Matrix3d S_i = rotation_to_displacement(nodes.D.row(i).transpose());
    for (Index j = 0; j < n; ++j) {
      const Matrix3d S_j = rotation_to_displacement(nodes.D.row(j).transpose());
      K.block<3, 3>(6 * i, 6 * j) = H(i, j) * Matrix3d::Identity();
      // u = sum N_i (u_i + zeta theta_i x D_i), and the mean of zeta^2 is 1/3
      K.block<3, 3>(6 * i + 3, 6 * j + 3) = H(i, j) / 3.0 * S_i.transpose() * S_j;
    }
  }
  return K;
}

MatrixXd beam_geometric_stiffness(const NodeVectors& x, const BeamSection& section,
                                  const VectorXd& u_e)
{
  const VectorXd forces = beam_section_forces(x, section) * u_e;
  MatrixXd K = MatrixXd::Zero(6 * x.rows(), 6 * x.rows());
  for (Index i = 0; i + 1 < x.rows(); ++i) {
    const RowVector3d along = x.row(i + 1) - x.row(i);
    K.block<12, 12>(6 * i, 6 * i) += forces[12 * i] * unit_beam(along, section);
  }
  return K;
}

Matrix3d arm_geometric_stiffness(const Vector3d& force, const Vector3d& arm)
{
  const Matrix3d product = force * arm.transpose();
  return 0.5 * (product + product.transpose()) - force.dot(arm) * Matrix3d::Identity();
}

}  // namespace chladni::plate
