#include "linear/cholesky/part_solver.hpp"

#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "linear/cholesky/petsc_factor.hpp"
#include "linear/kernels/dense_matrices.hpp"

namespace chladni::linear {

bool solves_for_parts(Mat factor)
{
  return supernodal_of(factor) != nullptr;
}

bool will_solve_for_parts(const OptionSource& source)
{
  std::array<char, 64> name{};
  PetscBool is_given = PETSC_FALSE;
  petsc::check(PetscOptionsGetString(source.database, source.prefix.c_str(),
                                     "-pc_factor_mat_solver_type", name.data(), name.size(),
                                     &is_given));
  return !is_given || std::string_view(name.data()) == supernodal;
}

namespace {

struct Part {
  SupernodalFactor* whole;
  std::shared_ptr<SupernodalPart> rows;
};

Part part_of(Mat factor, IS rows)
{
  SupernodalFactor* whole = supernodal_of(factor);
  if (whole == nullptr) {
    throw Error(
        fmt::format("part_solver: the factor solves for all rows only; take "
                    "-cms_pc_factor_mat_solver_type {}",
                    supernodal));
  }
  return {.whole = whole, .rows = std::make_shared<SupernodalPart>(whole->part(rows))};
}

}  // namespace

std::function<void(Mat B, Mat X)> part_solver(Mat factor, IS rows)
{
  return [part = part_of(factor, rows)](Mat B, Mat X) {
    if (B != X) petsc::check(MatCopy(B, X, SAME_NONZERO_PATTERN));
    part.whole->solve(*part.rows, LocalArray(X).columns());
  };
}

std::function<InverseForm(petsc::Matrix B)> part_form(Mat factor, IS rows)
{
  return [part = part_of(factor, rows)](petsc::Matrix B) -> InverseForm {
    if (part.whole->n_negative_pivots() == 0) {
      part.whole->solve_half(*part.rows, LocalArray(B).columns());
      return {.left = std::move(B), .forces = {}};
    }
    petsc::Matrix solutions;
    petsc::check(MatDuplicate(B, MAT_COPY_VALUES, solutions.put()));
    part.whole->solve(*part.rows, LocalArray(solutions).columns());
    return {.left = std::move(solutions), .forces = std::move(B)};
  };
}

bool halves(Mat factor)
{
  const SupernodalFactor* ours = supernodal_of(factor);
  return ours != nullptr && ours->n_negative_pivots() == 0;
}

InverseForm inverse_form(Mat factor, petsc::Matrix B)
{
  if (halves(factor)) {
    supernodal_of(factor)->solve_half(LocalArray(B).columns());
    return {.left = std::move(B), .forces = {}};
  }
  petsc::Matrix solutions = uninitialized_dense(B, LocalRows(B).n_cols());
  petsc::check(MatMatSolve(factor, B, solutions));
  return {.left = std::move(solutions), .forces = std::move(B)};
}

}  // namespace chladni::linear
