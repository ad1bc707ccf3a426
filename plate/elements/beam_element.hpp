#pragma once

#include <Eigen/Core>

#include <vector>

#include "plate/elements/shell_element.hpp"
#include "plate/elements/shell_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// Six components in the local axes of a section as linear forms in the DOFs of a line.
using SectionForms = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// A point on the axis of a line and the fields there.
struct AxisPoint {
  double length;         ///< of the axis for which it stands in a sum, m
  Eigen::RowVector3d x;  ///< m
  Eigen::Matrix3d axes;  ///< e_x, e_y, e_z as rows
  SectionForms motion;   ///< displacement u and rotation theta of the section
  SectionForms strain;   ///< eps, gamma_y, gamma_z and the curvatures kappa_x, kappa_y, kappa_z
};

/// The fields of a line of n nodes at the points that its energies need.
struct BeamFields {
  Eigen::Vector<double, 6> stiffness;  ///< EA, kappa_y GA, kappa_z GA, GJ, EI_y, EI_z
  std::vector<AxisPoint> strained;     ///< of the strain energy
  std::vector<AxisPoint> moved;        ///< of the kinetic energy
  /// [6 n x 6 n] N, Q_y, Q_z, M_x, M_y, M_z at each node, on the face with the normal +x
  Eigen::MatrixXd forces;
};

/// The choice of the fields of a line between those that `beam_fields` names.
enum class LineFields {
  best,          ///< by its shape
  isoparametric  ///< as on the edges of the surface elements that share its nodes
};

/// The fields of a line of order p = n - 1.
///
/// A straight one that is slender has the bending of `StraightBending`, which is far more accurate
/// where shear and rotary inertia count little, and of second order only where they count: so the
/// more nodes a line has, the more slender it must be. Displacement and twist along the axis are of
/// degree p. Two nodes are always joined so.
///
/// Any other line is isoparametric, with u and theta of degree p on the curved axis x(xi):
///   (eps, gamma) = u' + x' x theta,   kappa = theta',   ' = d/ds.
/// Strains at p Gauss points leave neither shear nor membrane locking, and just six motions
/// without strain. A beam that is rigid in shear has a shear stiffness of 1e5 12 EI / l^2 here.
/// @param x  [n x 3] nodes from end to end, m
/// @throws chladni::Error as `node_axes`.
/// Source: Zienkiewicz, Taylor and Too, Int. J. Numer. Meth. Eng. 3 (1971) 275, reduced
/// integration; Simo, Comput. Meth. Appl. Mech. Eng. 49 (1985) 55, the strains.
BeamFields beam_fields(const NodeVectors& x, const BeamSection& section,
                       LineFields fields = LineFields::best);

/// K_e and M_e of a line of order p = n - 1 with the fields of `beam_fields`. Two nodes are exact
/// in statics for loads at them, and so is a straight line of any order for loads at its ends. M_e
/// is consistent with K_e, with rotary inertia rho I and torsional inertia rho (I_y + I_z).
/// @param x  [n x 3] nodes from end to end, m
/// @throws chladni::Error as `beam_fields`.
/// Source: Przemieniecki, Theory of Matrix Structural Analysis (1968), sections 5.6 and 11.3, for
/// two nodes.
ElementMatrices beam_matrices(const NodeVectors& x, const BeamSection& section,
                              LineFields fields = LineFields::best);

/// Section forces at the nodes of a line, as linear forms S_e in the DOFs of its nodes: force (N,
/// Q_y, Q_z) and moment (M_x, M_y, M_z) in the axes of `node_axes`, which act on the face with the
/// normal +x. Q_z = dM_y/dx, Q_y = -dM_z/dx.
/// @param x  [n x 3] nodes from end to end, m
/// @return [6 n x 6 n] each node in turn; N, N m per m or rad
Eigen::MatrixXd beam_section_forces(const NodeVectors& x, const BeamSection& section,
                                    LineFields fields = LineFields::best);

/// The local axes e_x, e_y, e_z of a beam as rows.
/// @param along  its direction, of any length, m
/// @throws chladni::Error when `along` vanishes, or when y and z of the section differ and its
///         orientation is missing or parallel to the beam.
Eigen::Matrix3d beam_axes(const Eigen::RowVector3d& along, const BeamSection& section);

/// True if the nodes lie on their chord at equal distances.
/// @param x  [n x 3] nodes from end to end, m
bool is_straight(const NodeVectors& x);

/// The section with an orientation along the whole of a curved line: its own, or where it has none
/// and needs none the normal of the plane of the line, nearer to the global +z than to -z.
/// @param x  [n x 3] nodes from end to end, m
BeamSection oriented(const BeamSection& section, const NodeVectors& x);

/// The local axes at each node of a line, whose axis is the polynomial through its nodes.
/// @param x  [n x 3] nodes from end to end, m
/// @throws chladni::Error as `beam_axes`, also where the axes are not defined inside the line.
std::vector<Eigen::Matrix3d> node_axes(const NodeVectors& x, const BeamSection& section);

}  // namespace chladni::plate
