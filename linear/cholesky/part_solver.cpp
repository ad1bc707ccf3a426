#include "linear/cholesky/part_solver.hpp"

#include <array>
#include <memory>
#include <string_view>

#include "linear/cholesky/cholesky_types.hpp"
#include "linear/cholesky/local_array.hpp"
#include "linear/cholesky/supernodal_of.hpp"

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

std::function<void(Mat B, Mat X)> part_solver(Mat factor, IS rows)
{
  SupernodalFactor* whole = supernodal_of(factor);
  if (whole == nullptr) {
    throw Error(
        fmt::format("part_solver: the factor solves for all rows only; take "
                    "-cms_pc_factor_mat_solver_type {}",
                    supernodal));
  }
  const auto part = std::make_shared<SupernodalPart>(whole->part(rows));
  return [whole, part](Mat B, Mat X) {
    if (B != X) petsc::check(MatCopy(B, X, SAME_NONZERO_PATTERN));
    whole->solve(*part, LocalArray(X).columns());
  };
}

}  // namespace chladni::linear
