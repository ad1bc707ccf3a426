#pragma once

#include <Eigen/Core>

#include <array>

#include "plate/elements/interpolation.hpp"
#include "plate/plate_options.hpp"

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

/// The strain components that an energy includes.
enum class Strains { all, without_shear, shear };

/// The two Gauss points through the thickness; their weights are 1.
extern const std::array<double, 2> thickness_points;

/// S with S^T S = plane-stress elasticity, kappa = 5/6, for the Cartesian components (e_11, e_22, 2
/// e_12, 2 e_13, 2 e_23), without the rows of components that are not included.
/// @return [n x 5], sqrt(Pa)
Eigen::Matrix<double, Eigen::Dynamic, 5> elasticity_root(const Material& material, Strains which);

/// det(g) of the shell at point `q` of `frame` and height `zeta`.
double volume_element(const ShellFrame& frame, Eigen::Index q, double zeta);

/// [n_points] What the mass per volume element is multiplied by where directors lean away from the
/// normal, at folds and between the nodes of curved elements: |a_1 x a_2| t / 2 over a_1 x a_2 . d
/// with the tangents of ShellNodes::surface. The mass is then that of the thickness t along the
/// director times the area.
Eigen::VectorXd leaning(const Basis& basis, const ShellNodes& nodes);

/// K = sum over points of B^T C B det(g) w, with B the Cartesian strains in a frame whose third
/// axis is the director.
/// @param root  of C, from `elasticity_root`
Eigen::MatrixXd stiffness(const CovariantStrains& strains, const ShellFrame& frame,
                          const Points& points,
                          const Eigen::Matrix<double, Eigen::Dynamic, 5>& root);

/// R^T R, with both triangles filled.
Eigen::MatrixXd gram_matrix(const StrainRows& R);

}  // namespace chladni::plate
