#pragma once

#include <vector>

#include "linear/cholesky/supernodal/dealt_elimination.hpp"
#include "linear/cholesky/supernodal/fronts.hpp"
#include "linear/kernels/aligned_numbers.hpp"

namespace chladni::linear {

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
