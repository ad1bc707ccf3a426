#pragma once

#include "reduce/dense.hpp"

namespace chladni::reduce {

/// A + B, where B has as many rows as A.
SmallMatrix coefficient_sum(const SmallMatrix& A, const SmallMatrix& B);

/// Rows first .. last - 1 of A.
SmallMatrix row_range(const SmallMatrix& A, PetscInt first, PetscInt last);

/// A above B.
SmallMatrix stacked(const SmallMatrix& A, const SmallMatrix& B);

}  // namespace chladni::reduce
