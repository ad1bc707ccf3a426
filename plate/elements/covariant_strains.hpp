#pragma once

#include <Eigen/Core>
#include <array>

#include "plate/elements/interpolation.hpp"

namespace chladni::plate {

/// Rows of a strain component at points, as linear forms in the 6 DOFs (u, theta) of each node.
using StrainRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using NodeVectors = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// The geometry of a shell by the nodes of an element: x = sum N_i (x_i + zeta D_i), |zeta| <= 1.
struct ShellNodes {
  NodeVectors x;  ///< [n x 3] mid-surface, m
  NodeVectors D;  ///< [n x 3] half the thickness times the unit director, m
  /// [n x 3] the surface over whose area the thickness extends, m; empty: x.
  NodeVectors surface = {};
};

/// Mid-surface tangents a_1, a_2, director d and its derivatives d_1, d_2 at points, each [n_points
/// x 3].
struct ShellFrame {
  NodeVectors a_1, a_2, d, d_1, d_2;
};

/// Linearised covariant strains of the degenerated Reissner-Mindlin shell
///   u = sum N_i (u_i + zeta theta_i x D_i):
///   eps_ab = m_ab + zeta b_ab + zeta^2 c_ab        (ab = 11, 22, 12)
///   2 eps_a3 = g0_a + zeta g1_a                    (a = 1, 2)
struct CovariantStrains {
  std::array<StrainRows, 3> m, b, c;
  std::array<StrainRows, 2> g0, g1;
};

/// The frame of the surface at the points of `basis`.
ShellFrame shell_frame(const Basis& basis, const ShellNodes& nodes);

/// The strains to compute; the rows of the others stay empty.
enum class StrainParts { all, membrane, shear };

/// The compatible (displacement-based) strains at the points of `basis`.
CovariantStrains covariant_strains(const Basis& basis, const ShellNodes& nodes,
                                   StrainParts parts = StrainParts::all);

/// The compatible strains of a field whose shape functions differ from those of the surface.
/// @param frame      of the surface, at the points of `field`
/// @param directors  [n_field_nodes x 3] half-thickness directors that the rotations turn, m
CovariantStrains covariant_strains(const Basis& field, const ShellFrame& frame,
                                   const NodeVectors& directors,
                                   StrainParts parts = StrainParts::all);

}  // namespace chladni::plate
