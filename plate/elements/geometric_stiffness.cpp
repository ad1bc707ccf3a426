#include "plate/elements/geometric_stiffness.hpp"

#include <Eigen/Geometry>

#include "plate/elements/shell_element.hpp"
#include "plate/elements/shell_resultants.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
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

/// d/ds of u and theta: of u the strains without the turn of the axis with theta.
SectionForms slopes_of(const AxisPoint& point)
{
  SectionForms slopes = point.strain;
  slopes.row(1) += point.motion.row(5);
  slopes.row(2) -= point.motion.row(4);
  return slopes;
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
                                  const VectorXd& u_e, LineFields of_line)
{
  const double r_z = section.I_z / section.area, r_y = section.I_y / section.area;
  // The local components u, v, w, phi, psi_y, psi_z: a turn about y moves points by z, about z by
  // y.
  const Eigen::Vector<double, 6> weights(1.0, 1.0, 1.0, r_y + r_z, r_y, r_z);
  const BeamFields fields = beam_fields(x, section, of_line);
  MatrixXd K = MatrixXd::Zero(6 * x.rows(), 6 * x.rows());
  for (const AxisPoint& point : fields.strained) {
    const double N = fields.stiffness[0] * point.strain.row(0).dot(u_e);
    const SectionForms slopes = slopes_of(point);
    K += N * point.length * slopes.transpose() * weights.asDiagonal() * slopes;
  }
  return K;
}

Matrix3d arm_geometric_stiffness(const Vector3d& force, const Vector3d& arm)
{
  const Matrix3d product = force * arm.transpose();
  return 0.5 * (product + product.transpose()) - force.dot(arm) * Matrix3d::Identity();
}

}  // namespace chladni::plate
