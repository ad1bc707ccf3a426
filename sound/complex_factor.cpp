#include "sound/complex_factor.hpp"

#include <fmt/format.h>
#include <metis.h>
#include <mpi.h>

#include "common/error.hpp"

namespace chladni::sound {
namespace {

using Sparse = ComplexFactor::Sparse;

/// [n] place of each row in an order of elimination by nested dissection, from 1.
std::vector<int> nested_dissection(const Sparse& lower)
{
  const auto n = static_cast<std::size_t>(lower.rows());
  std::vector<idx_t> starts(n + 1, 0), neighbours;
  for (int j = 0; j < lower.outerSize(); ++j) {
    for (Sparse::InnerIterator a(lower, j); a; ++a) {
      if (a.row() == a.col()) continue;
      ++starts[std::size_t(a.row()) + 1];
      ++starts[std::size_t(a.col()) + 1];
    }
  }
  for (std::size_t i = 0; i < n; ++i) starts[i + 1] += starts[i];
  neighbours.resize(std::size_t(starts[n]));
  std::vector<idx_t> next(starts.begin(), starts.end() - 1);
  for (int j = 0; j < lower.outerSize(); ++j) {
    for (Sparse::InnerIterator a(lower, j); a; ++a) {
      if (a.row() == a.col()) continue;
      neighbours[std::size_t(next[std::size_t(a.row())]++)] = static_cast<idx_t>(a.col());
      neighbours[std::size_t(next[std::size_t(a.col())]++)] = static_cast<idx_t>(a.row());
    }
  }
  auto size = static_cast<idx_t>(n);
  std::vector<idx_t> order(n), place(n);
  if (METIS_NodeND(&size, starts.data(), neighbours.data(), nullptr, nullptr, order.data(),
                   place.data()) != METIS_OK)
    throw Error(fmt::format("METIS cannot order a matrix of {} rows", n));
  std::vector<int> places;
  for (const idx_t i : place) places.push_back(static_cast<int>(i) + 1);
  return places;
}

ZMUMPS_COMPLEX* entries(std::complex<double>* values)
{
  return reinterpret_cast<ZMUMPS_COMPLEX*>(values);  // both are two doubles
}

}  // namespace

ComplexFactor::ComplexFactor(const Sparse& lower) : order_(nested_dissection(lower))
{
  for (int j = 0; j < lower.outerSize(); ++j) {
    for (Sparse::InnerIterator a(lower, j); a; ++a) {
      rows_.push_back(static_cast<int>(a.row()) + 1);
      columns_.push_back(static_cast<int>(a.col()) + 1);
      values_.push_back(a.value());
    }
  }
  mumps_.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(MPI_COMM_SELF));
  mumps_.par = 1;
  mumps_.sym = 2;  // symmetric, indefinite
  call(-1, "start");
  mumps_.icntl[3] = 0;    // silent
  mumps_.icntl[6] = 1;    // ordering: ours
  mumps_.icntl[13] = 50;  // percent of working space for pivots that come late
  mumps_.n = static_cast<MUMPS_INT>(lower.rows());
  mumps_.nnz = static_cast<MUMPS_INT8>(values_.size());
  mumps_.irn = rows_.data();
  mumps_.jcn = columns_.data();
  mumps_.a = entries(values_.data());
  mumps_.perm_in = order_.data();
  call(1, "analysis");
  call(2, "factorisation");
}

ComplexFactor::~ComplexFactor()
{
  mumps_.job = -2;
  zmumps_c(&mumps_);
}

void ComplexFactor::call(int job, const char* what)
{
  mumps_.job = job;
  zmumps_c(&mumps_);
  if (mumps_.infog[0] >= 0) return;
  throw Error(
      fmt::format("MUMPS: the {} of {} complex equations failed with INFOG(1) = {}, "
                  "INFOG(2) = {}",
                  what, mumps_.n, mumps_.infog[0], mumps_.infog[1]));
}

Eigen::MatrixXcd ComplexFactor::solve(Eigen::MatrixXcd right_hand_sides)
{
  mumps_.nrhs = static_cast<MUMPS_INT>(right_hand_sides.cols());
  mumps_.lrhs = static_cast<MUMPS_INT>(right_hand_sides.rows());
  mumps_.rhs = entries(right_hand_sides.data());
  call(3, "solution");
  return right_hand_sides;
}

}  // namespace chladni::sound
