#pragma once

#include <Eigen/Core>

#include "common/petsc.hpp"

namespace chladni::linear {

/// X^T A Y for a symmetric sparse A and dense X, Y of many columns, on every rank: one sum for each
/// set of rows that A does not couple with others, over the columns that are not zero there. The
/// mass of a plane shell couples no direction with another, and constraint modes of bending have
/// nothing in the plane.
/// @note   Collective.
Eigen::MatrixXd parted_form(Mat X, Mat A, Mat Y);

/// X^T A X, symmetric to the last bit.
/// @note   Collective.
Eigen::MatrixXd parted_form(Mat X, Mat A);

}  // namespace chladni::linear
