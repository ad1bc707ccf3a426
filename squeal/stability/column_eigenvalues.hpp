#pragma once

#include <Eigen/Core>
#include <functional>

namespace chladni::squeal {

/// The i-th state matrix of a sequence.
using MatrixOf = std::function<Eigen::MatrixXd(Eigen::Index i)>;

/// How often each method computed the eigenvalues of a sequence.
struct SequenceCount {
  Eigen::Index by_discs;  ///< from the eigenvalues of the previous matrix; see eigenvalue_discs.hpp
  Eigen::Index by_qr;     ///< by the QR algorithm
};

/// The least stable eigenvalue of each matrix of a sequence along which one parameter changes: the
/// one with the largest real part and Im >= 0, 1/s.
struct LeastStableSequence {
  Eigen::VectorXcd lambda;
  SequenceCount count;
};

/// Computes the least stable eigenvalues of n matrices. If neighbours differ by a matrix of low
/// rank, as when the pads of a disc change, all eigenvalues are extrapolated from matrix to matrix
/// and corrected. If this does not identify the rightmost eigenvalue with certainty, and for other
/// sequences, the QR algorithm is used.
LeastStableSequence least_stable_eigenvalues(const MatrixOf& A, Eigen::Index n);

}  // namespace chladni::squeal
