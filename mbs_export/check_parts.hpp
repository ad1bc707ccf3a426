#pragma once

#include <Eigen/Core>
#include <string>

#include "mbs_export/check_body.hpp"

/// Parts that the checks of reduced systems and of modal bodies share.
namespace chladni::mbs_export::check_parts {

/// A check that fails above `limit` or for NaN, and warns within a factor of 100 below it.
Check bounded(const std::string& name, double value, double limit, const std::string& meaning);

/// A check that passes up to `limit` and has the verdict `otherwise` above it.
Check expected(const std::string& name, double value, double limit, Verdict otherwise,
               const std::string& meaning);

/// The largest |A_ij - A_ji| over sqrt(|A_ii A_jj|). Round-off of the largest entry is ignored.
double asymmetry(const Eigen::MatrixXd& A);

/// D A D with a unit diagonal, which removes units and scales. Rows without a positive diagonal are
/// scaled as the row with the largest one.
Eigen::MatrixXd unit_diagonal(const Eigen::MatrixXd& A);

/// The eigenvalues of a symmetric matrix over the largest one, ascending; empty for a zero matrix.
Eigen::VectorXd relative_eigenvalues(const Eigen::MatrixXd& A);

/// Checks that the principal moments are positive and none exceeds the sum of the other two.
Check check_inertia(const Eigen::Matrix3d& inertia);

/// Compares S_xx + S_yy + S_zz with the mass matrix M of the same coordinates.
Check check_mass_integrals(const MassIntegrals& integrals, const Eigen::MatrixXd& M);

/// Checks that the matrix of each load is symmetric.
Check check_stiffening(const Stiffening& stiffening);

/// Root mean square distance of the attachment nodes from their centre, m; 1 for a single node.
double characteristic_length(const std::vector<AttachmentNode>& nodes);

}  // namespace chladni::mbs_export::check_parts
