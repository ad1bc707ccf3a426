#pragma once

#include "linear/cholesky/factorization.hpp"

namespace chladni::linear {

/// |A|_1 |A^-1|_1. The second factor is a lower estimate (mostly exact) by Hager's method with at
/// most five solves.
/// @note   Collective.
/// Source: Hager, SIAM J. Sci. Stat. Comput. 5 (1984) 311; Higham, ACM Trans. Math. Softw. 14
/// (1988) 381.
double condition_estimate(const Factorization& A);

}  // namespace chladni::linear
