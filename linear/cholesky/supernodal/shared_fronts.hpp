#pragma once

#include <mpi.h>

#include <cstddef>
#include <vector>

#include "linear/cholesky/supernodal/fronts.hpp"
#include "linear/cholesky/supernodal/rank_groups.hpp"
#include "linear/kernels/storage.hpp"

namespace chladni::linear {

/// The rows of a front that were dealt to a rank. All matrices are stored by columns.
struct DealtFront {
  DealtRows rows;
  int place;          ///< of this rank in the group
  MPI_Comm comm;      ///< of the group
  double* L;          ///< [own rows x n_columns] lower triangle of A; becomes L, with D
  double* rest;       ///< [own rows below x n_below] lower triangle of what is left for the parent
  double* triangle;   ///< [n_columns x n_columns] becomes the L of the columns, on all ranks
  double* D;          ///< [n_columns] becomes D, on all ranks
  double* workspace;  ///< of `size_of_workspace`

  int n_own() const { return rows.count(place, 0, rows.n_rows()); }
  int n_own_pivots() const { return rows.count(place, 0, rows.n_columns()); }
};

std::size_t size_of_workspace(const DealtRows& rows, int place);

/// A = L D L^T for the columns, and rest <- rest - L_21 D L_21^T, without pivoting. Groups of
/// columns are eliminated by all ranks, the rows under them by the ranks that have them. It goes on
/// where a pivot fails: ranks on different processors may not agree about that.
/// @return the number of negative pivots; -1 at a pivot that is zero or NaN
/// @note   Collective over the group.
int eliminate_dealt(const DealtFront& front);

/// Replaces the own rows of L by those of L_11^-1 and L_21 L_11^-1.
void divide_by_triangle(const DealtFront& front);

/// The elimination of fronts by groups of ranks, each of which has the rows that were dealt to it.
class SharedFronts {
 public:
  /// @param group  [n_supernodes] ranks that eliminate it
  /// @param own    the fronts of this rank alone, which leave something to those here
  SharedFronts(const AssemblyTree& tree, const std::vector<RankGroup>& group, Fronts& own, int rank)
      : tree_(tree),
        group_(group),
        own_(own),
        places_(tree),
        rank_(rank),
        left_over_(tree.n_supernodes())
  {}

  /// Takes the memory for the front of s, and puts the entries of the matrix into it.
  /// @throws chladni::Error when the matrix has entries outside the structure of the tree.
  void prepare(int s, const MatrixRows& A);
  /// Eliminates s, which was prepared on all ranks of its group.
  /// @return the number of negative pivots; -1 at a pivot that is zero or NaN
  /// @note   Collective over the group, whose communicator is given.
  int eliminate(int s, MPI_Comm comm);
  /// What was eliminated last.
  const DealtFront& front() const { return front_; }

 private:
  int owner_below(int s, const DealtRows& rows, int below) const;
  /// A row of what a child left over, its number among those that this rank has (or among the own
  /// rows of the front), and the place of the rank that gets (or has) it.
  struct MovedRow {
    int row, own, other;
  };
  std::vector<MovedRow> sent_rows(int child) const;
  std::vector<MovedRow> received_rows(int child) const;
  void plan_exchange(int s);
  void pack(int s);
  void unpack(int s);

  const AssemblyTree& tree_;
  const std::vector<RankGroup>& group_;
  Fronts& own_;
  FrontPlaces places_;
  int rank_;
  std::vector<std::vector<double>> left_over_;  ///< [n_supernodes] own rows, lower triangle
  DealtFront front_{.rows = {0, 0, {0, 1}, 0},
                    .place = 0,
                    .comm = MPI_COMM_NULL,
                    .L = nullptr,
                    .rest = nullptr,
                    .triangle = nullptr,
                    .D = nullptr,
                    .workspace = nullptr};
  /// Memory that is used again and not touched before it is written.
  struct Buffer {
    AlignedNumbers numbers;
    std::size_t size = 0;

    double* of(std::size_t n)
    {
      if (n > size) {
        numbers.reset();
        numbers = aligned_numbers(n);
        size = n;
      }
      return numbers.get();
    }
  };
  Buffer L_, triangle_, D_, workspace_, sent_, received_;
  std::vector<int> own_row_;  ///< [rows of the front] its number among the own ones; -1: not here
  std::vector<int> sent_counts_, received_counts_, sent_at_, received_at_;
};

}  // namespace chladni::linear
