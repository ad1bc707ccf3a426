#pragma once

#include <Eigen/Core>
#include <span>

#include "common/petsc.hpp"

namespace chladni::linear {

/// X^T A Y for a symmetric sparse A and dense X, Y of many columns, on every rank. It is a sum over
/// sets of rows that A does not couple with others, with the columns that are not zero there; sets
/// with the same columns are merged. The mass of a plane shell couples no two directions, and
/// constraint modes of bending are zero in the plane.
/// @note   Collective.
Eigen::MatrixXd parted_form(Mat X, Mat A, Mat Y);

enum class FormSymmetry { none, symmetric };

/// X^T A X with X = [X_1 X_2 ...] for any A; rows are coupled by an entry on either side of the
/// diagonal. For a symmetric A the result is symmetric to the last bit and takes half the work.
/// @note   Collective.
Eigen::MatrixXd parted_form(std::span<const Mat> X, Mat A, FormSymmetry symmetry);

/// [X_1 X_2 ...]^T A X_1 for a symmetric A. Its first block, X_1^T A X_1, is symmetric to the last
/// bit.
/// @note   Collective.
Eigen::MatrixXd leading_columns_of_form(std::span<const Mat> X, Mat A);

}  // namespace chladni::linear
