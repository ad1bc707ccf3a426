#pragma once

#include <Eigen/Core>
#include <string>

namespace chladni::mbs_export::formats {

/// The form of a matrix in Nastran.
enum class MatrixForm { rectangular = 2, symmetric = 6 };

/// A real double-precision matrix in the formatted, non-sparse OUTPUT4 layout. Its 17 significant
/// digits restore the same numbers. Entries below 1e-99 become zero.
/// @param name  up to 8 letters
/// @throws chladni::Error when an entry is not finite or above 1e99.
std::string op4_matrix(const std::string& name, const Eigen::MatrixXd& A, MatrixForm form);

}  // namespace chladni::mbs_export::formats
