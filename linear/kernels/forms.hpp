#pragma once

#include <Eigen/Core>

#include <functional>
#include <span>
#include <vector>

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

/// Rows that a matrix A does not couple with others, and the columns that are not zero in these
/// rows.
struct FormPart {
  std::vector<PetscInt> rows;                  ///< of this rank, counted from its first, ascending
  std::vector<std::vector<PetscInt>> columns;  ///< of each X, the same on every rank
};

/// The parts whose sum is the form X^T A X. Rows without an entry of A are in none. Sets of rows
/// with the same columns are one part, so that the columns are read once.
/// @param X  dense, with the rows of A
/// @return empty if all rows form one part
/// @note   Collective.
std::vector<FormPart> form_parts(Mat A, std::span<const Mat> X);

/// The submatrix of A with the rows and columns of a part.
/// @note   Collective.
petsc::Matrix matrix_of(const FormPart& part, Mat A);

/// A dense matrix of many columns that is not stored as one.
struct ColumnSource {
  PetscInt n_columns;
  /// Writes this rank's rows of a column.
  std::function<void(PetscInt column, std::span<double> rows)> write;
};

struct SparseForm {
  Mat A;
  FormSymmetry symmetry;
};

/// T^T A T of several matrices that have entries in some of the components of a node only, as those
/// that tell of one direction have: the rows of each component are copied once for all of them,
/// without the columns that are zero there.
/// @param T      its rows are distributed as those of each A
/// @param forms  AIJ of the same layout; their block size is the number of components
/// @return on every rank; symmetric to the last bit where A is said to be
/// @note   Collective.
std::vector<Eigen::MatrixXd> component_forms(const ColumnSource& T,
                                             std::span<const SparseForm> forms);

}  // namespace chladni::linear
