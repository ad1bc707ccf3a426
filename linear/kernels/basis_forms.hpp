#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/parted_form.hpp"

namespace chladni::linear {

/// A sparse matrix whose form is wanted.
struct SparseForm {
  Mat A;
  FormSymmetry symmetry;
};

/// X^T A X of several sparse matrices with X = [X_1 X_2 ...], which is read once for all of them. A
/// few thousand rows at a time stay in the caches with their products. For a symmetric A the result
/// is symmetric to the last bit and takes half the work.
/// @param coupled  AIJ; columns of X may be zero in some of the sets of rows that it does not
///                 couple, as those of bending are in the plane of a flat shell
/// @param forms    AIJ with the rows of `coupled`
/// @note   Collective.
std::vector<Eigen::MatrixXd> basis_forms(std::span<const Mat> X, Mat coupled,
                                         std::span<const SparseForm> forms);

}  // namespace chladni::linear
