#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

enum class Verdict { pass, warn, fail };

/// A property that a sound body has, and how well a given body has it.
struct Check {
  std::string name;  ///< "symmetry of K", "rigid-body energy", ...
  Verdict verdict;
  double value;         ///< a relative error, or a count
  double limit;         ///< a check warns or fails above it; NaN if every value is allowed
  std::string meaning;  ///< what was compared, or what is probably wrong
};

/// Checks a reduced system: symmetry, definiteness, rigid-body energy and grounding, mechanisms,
/// mass and inertia, the block of the fixed-interface modes, orthogonality of the free modes,
/// condition numbers. Relative errors fail above their limit and warn within a factor of 100 below
/// it.
std::vector<Check> check_reduced(const ReducedSystem& reduced);

/// Checks a modal body: the number of rigid modes, rigid modes against geometry and inertia, held
/// displacements, frequencies against those of the free body, damping, mass and inertia,
/// conditioning, contact rings against the attachment nodes.
std::vector<Check> check_body(const ModalBody& body);

/// The worst verdict of all checks; `pass` if there are none.
Verdict worst(const std::vector<Check>& checks);

}  // namespace chladni::mbs_export

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
