#pragma once

#include <Eigen/Core>
#include <string>

#include "mbs_export/check_body.hpp"

/// What the checks of a reduced system and of a modal body have in common.
namespace chladni::mbs_export::check_parts {

/// Fails beyond `limit` or when not a number, warns within a factor of 100 of it.
Check bounded(const std::string& name, double value, double limit, const std::string& meaning);

/// Passes or else has the verdict `otherwise`.
Check expected(const std::string& name, double value, double limit, Verdict otherwise,
               const std::string& meaning);

/// Largest |A_ij - A_ji| over sqrt(|A_ii A_jj|), with round-off of the largest entry forgiven.
double asymmetry(const Eigen::MatrixXd& A);

/// D A D with the unit diagonal that takes units and scales out; rows without a positive diagonal
/// are scaled by the largest one.
Eigen::MatrixXd unit_diagonal(const Eigen::MatrixXd& A);

/// Eigenvalues of a symmetric matrix over the largest one, ascending; empty for a matrix of zeros.
Eigen::VectorXd relative_eigenvalues(const Eigen::MatrixXd& A);

/// Principal moments of any body are positive, and none exceeds the sum of the other two.
Check check_inertia(const Eigen::Matrix3d& inertia);

/// S_xx + S_yy + S_zz against the mass matrix M of the same coordinates.
Check check_mass_integrals(const MassIntegrals& integrals, const Eigen::MatrixXd& M);

/// Symmetry of the matrices of each load.
Check check_stiffening(const Stiffening& stiffening);

/// Root mean square distance of the attachment nodes from their centre, m; 1 for a single point.
double characteristic_length(const std::vector<AttachmentNode>& nodes);

}  // namespace chladni::mbs_export::check_parts
