#include "linear/cholesky/supernodal/dense_elimination.hpp"

#include <petscsys.h>
// needs the types of petscsys.h
#include <petscblaslapack.h>

#include <algorithm>

#include "common/fitting_instructions.hpp"

namespace chladni::linear {

namespace {

constexpr int panel_columns = 24;  // eliminated one by one
constexpr int block_columns = 64;  // of a lower triangle that are updated as a rectangle

CHLADNI_FITTING_INSTRUCTIONS
void subtract_multiple(double factor, const double* __restrict x, int n, double* __restrict y)
{
  for (int i = 0; i < n; ++i) y[i] -= factor * x[i];
}

/// y <- scale y - X Z^T with X [n x k] and Z [m x k], both of leading dimension ld.
struct Update {
  int n, m, k;
  const double* X;
  const double* Z;
  int ld;
};

void subtract(const Update& u, double scale, double* Y, int ldy)
{
  if (u.n == 0 || u.m == 0) return;
  const PetscBLASInt n = u.n, m = u.m, k = u.k, ld = u.ld, ld_Y = ldy;
  const double minus_one = -1.0;
  BLASgemm_("N", "T", &n, &m, &k, &minus_one, u.X, &ld, u.Z, &ld, &scale, Y, &ld_Y);
}

}  // namespace

int eliminate_columns(const FrontColumns& front)
{
  const int n = front.n_rows;
  const auto at = [n](int row, int column) { return row + std::size_t(column) * n; };
  int n_negative = 0;
  for (int first = 0; first < front.n_columns; first += panel_columns) {
    const int last = std::min(first + panel_columns, front.n_columns);
    for (int j = first; j < last; ++j) {
      const double pivot = front.A[at(j, j)];
      if (!(pivot > 0.0 || pivot < 0.0)) return -1;
      if (pivot < 0.0) ++n_negative;
      for (int i = j + 1; i < n; ++i) {
        front.W[at(i, j)] = front.A[at(i, j)];
        front.A[at(i, j)] /= pivot;
      }
      for (int c = j + 1; c < last; ++c)
        subtract_multiple(front.W[at(c, j)], front.A + at(c, j), n - c, front.A + at(c, c));
    }
    for (int c = last; c < front.n_columns; c += block_columns) {
      const int width = std::min(block_columns, front.n_columns - c);
      subtract({n - c, width, last - first, front.A + at(c, first), front.W + at(c, first), n}, 1.0,
               front.A + at(c, c), n);
    }
  }
  return n_negative;
}

void subtract_from_rest(const FrontColumns& front, double scale, double* C)
{
  const int n_rest = front.n_rows - front.n_columns;
  for (int c = 0; c < n_rest; c += block_columns) {
    const int width = std::min(block_columns, n_rest - c), row = front.n_columns + c;
    subtract({n_rest - c, width, front.n_columns, front.A + row, front.W + row, front.n_rows},
             scale, C + c + std::size_t(c) * n_rest, n_rest);
  }
}

}  // namespace chladni::linear
