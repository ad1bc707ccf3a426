#pragma once

#include <Eigen/Core>
#include <span>

#include "common/petsc.hpp"

namespace chladni::linear {

/// X^T A Y for a symmetric sparse A and dense X, Y of many columns, on every rank: one sum for each
/// set of rows that A does not couple with others, over the columns that are not zero there; sets
/// with the same columns are one. The mass of a plane shell couples no direction with another, and
/// constraint modes of bending have nothing in the plane.
/// @note   Collective.
Eigen::MatrixXd parted_form(Mat X, Mat A, Mat Y);

enum class FormSymmetry { none, symmetric };

/// The same of X = [X_1 X_2 ...] with itself and any A, coupled rows being those with an entry on
/// either side of the diagonal. Of a symmetric A it is symmetric to the last bit and half the work.
/// @note   Collective.
Eigen::MatrixXd parted_form(std::span<const Mat> X, Mat A, FormSymmetry symmetry);

/// [X_1 X_2 ...]^T A X_1 of a symmetric A: the columns of that form which belong to X_1, whose
/// first block is symmetric to the last bit.
/// @note   Collective.
Eigen::MatrixXd leading_columns_of_form(std::span<const Mat> X, Mat A);

}  // namespace chladni::linear
