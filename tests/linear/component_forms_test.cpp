#include "linear/kernels/forms.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "matrices.hpp"

namespace chladni::linear {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr PetscInt n_components = 4, n_nodes = 37, n_rows = n_components * n_nodes;
constexpr PetscInt n_columns = 150;  // more than are multiplied at a time

/// Whole nodes on each rank, entries between neighbouring nodes for some pairs of components.
/// @param value  of a pair of rows, 0: no entry
petsc::Matrix node_matrix(const std::function<double(PetscInt i, PetscInt j)>& value)
{
  const PetscInt n_ranks = petsc::size(PETSC_COMM_WORLD), rank = petsc::rank(PETSC_COMM_WORLD);
  const PetscInt n_own = n_components * (n_nodes / n_ranks + (rank < n_nodes % n_ranks ? 1 : 0));
  petsc::Matrix A;
  petsc::check(MatCreateAIJ(PETSC_COMM_WORLD, n_own, n_own, n_rows, n_rows, 3 * n_components,
                            nullptr, 3 * n_components, nullptr, A.put()));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt i = first; i < last; ++i)
    for (PetscInt j = 0; j < n_rows; ++j)
      if (std::abs(i / n_components - j / n_components) < 2 && value(i, j) != 0.0)
        petsc::check(MatSetValue(A, i, j, value(i, j), INSERT_VALUES));
  testing::finish(A);
  petsc::check(MatSetBlockSize(A, n_components));
  return A;
}

double entry(PetscInt i, PetscInt j)
{
  return std::sin(1.0 + double(i) + 0.7 * double(j));
}

/// Components 0 and 3 are zero in every second column, 1 and 2 in the others.
double column_value(PetscInt i, PetscInt j)
{
  const PetscInt c = i % n_components;
  const bool is_of_0_and_3 = c == 0 || c == 3;
  return is_of_0_and_3 == (j % 2 == 0) ? std::cos(0.3 * double(i) * double(j + 1)) : 0.0;
}

MatrixXd dense_of_values(PetscInt n, const std::function<double(PetscInt, PetscInt)>& value)
{
  MatrixXd A(n_rows, n);
  for (PetscInt j = 0; j < n; ++j)
    for (PetscInt i = 0; i < n_rows; ++i) A(i, j) = value(i, j);
  return A;
}

struct Form {
  std::function<double(PetscInt, PetscInt)> value;
  FormSymmetry symmetry;
};

/// A value where two components are coupled, between neighbouring nodes.
Form form(std::vector<std::array<PetscInt, 2>> pairs, FormSymmetry symmetry)
{
  const auto value = [=](PetscInt i, PetscInt j) {
    const std::array at{i % n_components, j % n_components}, back{at[1], at[0]};
    const bool is_symmetric = symmetry == FormSymmetry::symmetric;
    if (std::abs(i / n_components - j / n_components) > 1) return 0.0;
    for (const auto& pair : pairs)
      if (pair == at || (is_symmetric && pair == back))
        return is_symmetric ? entry(i, j) + entry(j, i) : entry(i, j);
    return 0.0;
  };
  return {.value = value, .symmetry = symmetry};
}

TEST(ComponentForms, AreThoseOfDenseMatrices)
{
  using enum FormSymmetry;
  const std::array forms{
      form({{0, 0}, {1, 1}}, symmetric),
      form({{2, 2}, {2, 3}}, symmetric),
      form({{0, 1}}, none),
      form({{0, 0}, {0, 1}, {0, 2}, {3, 3}}, none),
      form({}, none),
  };
  std::vector<petsc::Matrix> matrices;
  std::vector<SparseForm> sparse;
  for (const Form& some : forms) {
    matrices.push_back(node_matrix(some.value));
    sparse.push_back({.A = matrices.back(), .symmetry = some.symmetry});
  }
  PetscInt first = 0;
  petsc::check(MatGetOwnershipRange(matrices.front(), &first, nullptr));
  const auto write = [&](PetscInt j, std::span<double> rows) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i] = column_value(first + static_cast<PetscInt>(i), j);
  };
  const std::vector<MatrixXd> found =
      component_forms({.n_columns = n_columns, .write = write}, sparse);
  ASSERT_EQ(found.size(), forms.size());
  const MatrixXd T = dense_of_values(n_columns, column_value);
  for (std::size_t k = 0; k < forms.size(); ++k) {
    const MatrixXd wanted = T.transpose() * dense_of_values(n_rows, forms[k].value) * T;
    EXPECT_LE((found[k] - wanted).norm(), 1e-13 * wanted.norm()) << k;
    if (forms[k].symmetry == symmetric) {
      EXPECT_EQ(found[k], MatrixXd(found[k].transpose())) << k;
    }
  }
  EXPECT_GT((found[3] - found[3].transpose()).norm(), 0.1 * found[3].norm());
}

}  // namespace
}  // namespace chladni::linear
