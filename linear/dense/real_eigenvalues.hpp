#pragma once

#include <Eigen/Core>

namespace chladni::linear {

/// The eigenvalues of a real matrix, of which no eigenvector is asked for; of a complex pair the
/// one with the positive imaginary part first. Takes a third of the time of Eigen::EigenSolver,
/// which transforms all of the triangle also where it keeps no vectors.
/// @param A  [n x n]
/// @throws chladni::Error where the QR iteration does not converge, as for what is not finite.
Eigen::VectorXcd real_eigenvalues(const Eigen::MatrixXd& A);

}  // namespace chladni::linear
