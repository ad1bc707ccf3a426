#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/eigen_every.hpp"
#include "plate/elements/beam_element.hpp"

namespace chladni::plate::testing {

/// Equidistant nodes, [n + 1 x 3].
inline NodeVectors line(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b, Eigen::Index n)
{
  NodeVectors x(n + 1, 3);
  for (Eigen::Index i = 0; i <= n; ++i) x.row(i) = a + double(i) / double(n) * (b - a);
  return x;
}

/// Equidistant nodes of a circle about z, [n x 3].
inline NodeVectors circle(double radius, Eigen::Index n)
{
  NodeVectors x = NodeVectors::Zero(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * double(i) / double(n);
    x.row(i) << radius * std::cos(angle), radius * std::sin(angle), 0.0;
  }
  return x;
}

/// Assembles `of` (x of a line) over lines.
template <class Matrix>
Eigen::MatrixXd assembled(const NodeVectors& x, const std::vector<std::vector<Eigen::Index>>& lines,
                          const Matrix& of)
{
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(6 * x.rows(), 6 * x.rows());
  for (const std::vector<Eigen::Index>& nodes : lines) {
    std::vector<Eigen::Index> dofs;
    for (const Eigen::Index node : nodes)
      for (Eigen::Index c = 0; c < 6; ++c) dofs.push_back(6 * node + c);
    sum(dofs, dofs) += of(NodeVectors(x(nodes, every)), dofs);
  }
  return sum;
}

inline ElementMatrices matrices_of(const NodeVectors& x,
                                   const std::vector<std::vector<Eigen::Index>>& lines,
                                   const BeamSection& section)
{
  return {.K = assembled(x, lines,
                         [&](const NodeVectors& of_line, const auto& /*dofs*/) {
                           return beam_matrices(of_line, section).K;
                         }),
          .M = assembled(x, lines, [&](const NodeVectors& of_line, const auto& /*dofs*/) {
            return beam_matrices(of_line, section).M;
          })};
}

/// K and M of lines of an order from the first node to the last.
inline ElementMatrices beam_mesh(const NodeVectors& x, int order, const BeamSection& section)
{
  std::vector<std::vector<Eigen::Index>> lines;
  for (Eigen::Index first = 0; first + order < x.rows(); first += order) {
    lines.emplace_back();
    for (int i = 0; i <= order; ++i) lines.back().push_back(first + i);
  }
  return matrices_of(x, lines, section);
}

/// Lines of an order along a circle of nodes.
inline std::vector<std::vector<Eigen::Index>> ring_lines(Eigen::Index n_nodes, int order)
{
  std::vector<std::vector<Eigen::Index>> lines;
  for (Eigen::Index first = 0; first < n_nodes; first += order) {
    lines.emplace_back();
    for (int i = 0; i <= order; ++i) lines.back().push_back((first + i) % n_nodes);
  }
  return lines;
}

/// The matrices without the rows and columns of held DOFs.
inline ElementMatrices held(const ElementMatrices& free, const std::vector<Eigen::Index>& held_dofs)
{
  std::vector<Eigen::Index> rest;
  for (Eigen::Index i = 0; i < free.K.rows(); ++i)
    if (std::ranges::find(held_dofs, i) == held_dofs.end()) rest.push_back(i);
  return {.K = free.K(rest, rest), .M = free.M(rest, rest)};
}

/// Bending in the x-z plane alone: u_z and theta_y of each node.
inline ElementMatrices in_plane(const ElementMatrices& all)
{
  std::vector<Eigen::Index> dofs;
  for (Eigen::Index i = 0; i < all.K.rows(); i += 6) dofs.insert(dofs.end(), {i + 2, i + 4});
  return {.K = all.K(dofs, dofs), .M = all.M(dofs, dofs)};
}

/// Of a held system, rad/s, ascending.
inline Eigen::VectorXd frequencies(const ElementMatrices& system)
{
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(system.M, system.K);
  return solver.eigenvalues().reverse().cwiseInverse().cwiseSqrt();
}

/// The deep beam of NAFEMS FV5, 2 m by 2 m, or a square section of another side.
inline BeamSection deep_beam(double side = 2.0)
{
  const double I = std::pow(side, 4) / 12.0;
  return {.group = "beam",
          .material = {.young = 2e11, .poisson = 0.3, .density = 8000.0},
          .area = side * side,
          .I_y = I,
          .I_z = I,
          .J = 0.1406 * std::pow(side, 4),
          .shear_factor_y = 0.85,
          .shear_factor_z = 0.85,
          .orientation = std::array{0.0, 0.0, 1.0}};
}

/// Frequency of the n-th mode of a simply supported beam, rad/s: the lower root of
/// (rho^2 I / kG) w^4 - (rho A + rho I k^2 (1 + E / kG)) w^2 + EI k^4 = 0, k = n pi / L.
inline double timoshenko_frequency(const BeamSection& s, double L, int n)
{
  const double E = s.material.young, rho = s.material.density;
  const double kG = s.shear_factor_z * 0.5 * E / (1.0 + s.material.poisson);
  const double k2 = std::pow(n * std::numbers::pi / L, 2);
  const double a = rho * rho * s.I_y / kG;
  const double b = rho * s.area + rho * s.I_y * k2 * (1.0 + E / kG);
  const double c = E * s.I_y * k2 * k2;
  return std::sqrt(2.0 * c / (b + std::sqrt(b * b - 4.0 * a * c)));
}

/// A straight beam of lines of an order, n intervals between nodes.
struct Divided {
  double length;  ///< m
  int order;
  Eigen::Index n;
};

/// In the x-z plane, with u_z held at both ends; rad/s.
inline Eigen::VectorXd simply_supported_frequencies(const BeamSection& s, const Divided& beam)
{
  const NodeVectors x = line({0, 0, 0}, {beam.length, 0, 0}, beam.n);
  return frequencies(held(in_plane(beam_mesh(x, beam.order, s)), {0, 2 * beam.n}));
}

}  // namespace chladni::plate::testing
