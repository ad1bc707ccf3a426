#pragma once

#include <Eigen/Core>
#include <functional>

namespace chladni::squeal {

/// The i-th of a sequence of state matrices.
using MatrixOf = std::function<Eigen::MatrixXd(Eigen::Index i)>;

/// How a sequence was computed.
struct SequenceCount {
  Eigen::Index by_discs;  ///< from the eigenvalues of the matrix before, see eigenvalue_discs.hpp
  Eigen::Index by_qr;     ///< by the QR iteration
};

/// The least stable eigenvalue of each matrix of a sequence along which one parameter changes: that
/// with the largest real part, Im >= 0, 1/s.
struct LeastStableSequence {
  Eigen::VectorXcd lambda;
  SequenceCount count;
};

/// Where neighbours differ by a matrix of low rank, as where the pads of a disc change, all
/// eigenvalues are extrapolated from matrix to matrix and corrected; where that finds no rightmost
/// eigenvalue with certainty, and for all other sequences, the QR iteration does.
LeastStableSequence least_stable_eigenvalues(const MatrixOf& A, Eigen::Index n);

}  // namespace chladni::squeal
