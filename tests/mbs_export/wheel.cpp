#include "wheel.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace chladni::mbs_export::test {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

Matrix3d cross_matrix(const Vector3d& l)
{
  Matrix3d S;
  S << 0, -l.z(), l.y(), l.z(), 0, -l.x(), -l.y(), l.x(), 0;
  return S;
}

/// Adds B^T D B of the beam between nodes a and b.
void add_beam(ReducedSystem& system, int a, int b)
{
  const Vector3d l = system.attachment_nodes[std::size_t(b)].position -
                     system.attachment_nodes[std::size_t(a)].position;
  Eigen::Matrix<double, 6, 12> B = Eigen::Matrix<double, 6, 12>::Zero();
  // gamma = u_b - u_a - (theta_a + theta_b) / 2 x l
  B.block<3, 3>(0, 0) = -Matrix3d::Identity();
  B.block<3, 3>(0, 6) = Matrix3d::Identity();
  B.block<3, 3>(0, 3) = B.block<3, 3>(0, 9) = 0.5 * cross_matrix(l);
  B.block<3, 3>(3, 3) = -Matrix3d::Identity();
  B.block<3, 3>(3, 9) = Matrix3d::Identity();
  const Eigen::Vector<double, 6> D(3e7, 3e7, 1e7, 1e4, 1e4, 3e4);  // N/m, N m
  const Eigen::Matrix<double, 12, 12> K_e = B.transpose() * D.asDiagonal() * B / l.norm() * 0.1;
  const int start[] = {6 * a, 6 * b};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      system.K.block<6, 6>(start[i], start[j]) += K_e.block<6, 6>(6 * i, 6 * j);
}

/// Of lumped masses m with the inertia J about any axis: int r r^T dm = J / 2, so that
/// int (theta x r)_k (theta' x r)_l dm = J / 2 (delta_kl theta . theta' - theta_l theta'_k).
MassIntegrals integrals_of_nodes(const ReducedSystem& system)
{
  const Eigen::Index n = system.M.rows();
  MassIntegrals integrals{.mass = 0.0,
                          .first = Vector3d::Zero(),
                          .second = Matrix3d::Zero(),
                          .displacement = Eigen::MatrixXd::Zero(3, n),
                          .position_displacement = Eigen::MatrixXd::Zero(9, n),
                          .products = {}};
  integrals.products.fill(Eigen::MatrixXd::Zero(n, n));
  for (Eigen::Index i = 0; i < n; i += 6) {
    const double m = system.M(i, i), half_J = 0.5 * system.M(i + 3, i + 3);
    const Vector3d x = system.attachment_nodes[std::size_t(i / 6)].position;
    integrals.mass += m;
    integrals.first += m * x;
    integrals.second += m * x * x.transpose() + half_J * Matrix3d::Identity();
    integrals.displacement.block<3, 3>(0, i) = m * Matrix3d::Identity();
    for (int k = 0; k < 3; ++k) {
      integrals.position_displacement.block<3, 3>(3 * k, i) = m * x[k] * Matrix3d::Identity();
      // int r_k (theta x r) dm = theta x e_k J / 2
      integrals.position_displacement.block<3, 3>(3 * k, i + 3) =
          -half_J * cross_matrix(Vector3d::Unit(k));
    }
    for (std::size_t s = 0; s < product_axes.size(); ++s) {
      const auto [k, l] = product_axes[s];
      Eigen::MatrixXd& S = integrals.products[s];
      S(i + k, i + l) = m;
      if (k == l) S.block<3, 3>(i + 3, i + 3) = half_J * Matrix3d::Identity();
      S(i + 3 + l, i + 3 + k) -= half_J;
    }
  }
  return integrals;
}

}  // namespace

ReducedSystem wheel()
{
  ReducedSystem system;
  system.title = "wheel";
  system.sets = {{"rim", {}}, {"hub", {wheel_rim_nodes}}};
  for (int i = 0; i < wheel_rim_nodes; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / wheel_rim_nodes;
    system.attachment_nodes.push_back(
        {100 + i, {wheel_radius * std::cos(angle), wheel_radius * std::sin(angle), wheel_height}});
    system.sets[0].nodes.push_back(i);
  }
  system.attachment_nodes.push_back({-1, Vector3d::Zero()});
  for (int node = 0; node <= wheel_rim_nodes; ++node)
    for (int component = 0; component < 6; ++component) system.masters.push_back({node, component});
  const int n = static_cast<int>(system.masters.size());
  system.K = system.M = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < wheel_rim_nodes; ++i) {
    add_beam(system, i, (i + 1) % wheel_rim_nodes);
    add_beam(system, i, wheel_rim_nodes);
  }
  for (int row = 0; row < n; ++row) {
    const bool hub = row >= 6 * wheel_rim_nodes, rotation = row % 6 >= 3;
    system.M(row, row) =
        rotation ? (hub ? hub_inertia : rim_node_inertia) : (hub ? hub_mass : rim_node_mass);
  }
  system.K = 0.5 * (system.K + system.K.transpose()).eval();
  system.mass_integrals = integrals_of_nodes(system);
  return system;
}

ReducedSystem wheel_of_points()
{
  ReducedSystem points = wheel();
  MassIntegrals& integrals = *points.mass_integrals;
  double half_J = 0.0;
  for (Eigen::Index i = 0; i < points.M.rows(); i += 6) {
    half_J += 0.5 * points.M(i + 3, i + 3);
    for (Eigen::MatrixXd& S : integrals.products) S.block<3, 3>(i + 3, i + 3).setZero();
    integrals.position_displacement.middleCols<3>(i + 3).setZero();
  }
  integrals.second -= half_J * Eigen::Matrix3d::Identity();
  return points;
}

}  // namespace chladni::mbs_export::test
