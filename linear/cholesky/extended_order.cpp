#include "linear/cholesky/extended_order.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "linear/kernels/gather.hpp"

namespace chladni::linear {

std::vector<int> extended_order(Mat A, const std::vector<int>& known)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  const auto end = static_cast<int>(known.size());
  std::vector<int> behind;  // the known place at or behind which each own row comes
  for (PetscInt row = first; row < last; ++row) {
    int place = known[row];
    if (place == -1) {
      PetscInt n = 0;
      const PetscInt* columns = nullptr;
      petsc::check(MatGetRow(A, row, &n, &columns, nullptr));
      for (PetscInt k = 0; k < n; ++k) place = std::max(place, known[columns[k]]);
      petsc::check(MatRestoreRow(A, row, &n, &columns, nullptr));
    }
    behind.push_back(place == -1 ? end : place);
  }
  behind = gather_on_all(behind, MPI_INT, petsc::communicator(A));
  std::vector<int> order(behind.size()), places(behind.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int row) { return std::pair(behind[row], known[row] == -1 ? row + 1 : 0); };
  std::ranges::sort(order, {}, key);
  for (std::size_t i = 0; i < order.size(); ++i) places[order[i]] = static_cast<int>(i);
  return places;
}

}  // namespace chladni::linear
