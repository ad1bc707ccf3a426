#pragma once

#include "plate/elements/covariant_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

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
