#include "linear/cholesky/supernodal/front_places.hpp"

#include <utility>

#include "common/petsc.hpp"

namespace chladni::linear {

bool FrontPlaces::has(int position) const
{
  if (position < tree_.first_column[s_ + 1]) return true;
  const std::span<const int> below = tree_.below(s_);
  const int place = place_below_[position];
  return std::cmp_less(place, below.size()) && below[place] == position;
}

void FrontPlaces::refuse(int row, PetscInt column)
{
  throw Error(
      fmt::format("supernodal: row {} has an entry in column {} that the matrix of the symbolic "
                  "factorisation had not; call MatCholeskyFactorSymbolic for each new pattern",
                  row, column));
}

}  // namespace chladni::linear
