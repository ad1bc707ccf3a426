#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "linear/cholesky/cholesky_factor.hpp"
#include "linear/cholesky/supernodal/assembly_tree.hpp"
#include "linear/cholesky/supernodal/fronts.hpp"
#include "linear/cholesky/supernodal/rank_groups.hpp"
#include "linear/cholesky/supernodal/shared_fronts.hpp"
#include "linear/cholesky/supernodal/slot_exchange.hpp"
#include "linear/cholesky/supernodal/tiled_columns.hpp"
#include "linear/kernels/storage.hpp"

namespace chladni::linear {

/// Supernodes of some trees, children first: those of this rank, and those that it shares with its
/// groups, smallest group first.
struct Supernodes {
  std::vector<int> own;
  std::vector<std::vector<int>> shared;  ///< [groups of this rank]
};

/// The supernodes and the exchange with which to solve for rows that are coupled to no others.
struct SupernodalPart {
  Supernodes supernodes;
  SlotExchange exchange;
};

/// The signs of the pivots of A = L D L^T without pivoting.
struct PivotSigns {
  PetscInt n_negative;
  /// The largest sum over j of L_ij^2 |D_jj| relative to the terms of A_ii: 1 for a definite
  /// matrix, infinite if a pivot vanishes. The elimination amplifies round-off by this factor.
  double growth;
};

/// Our sparse factor L D L^T for many right-hand sides: nested dissection by METIS, multifrontal
/// elimination without pivoting, and triangular solutions that read the factor in the order of
/// memory, tile by tile, once for all columns of a block. Whole subtrees belong to one rank; of the
/// fronts above them, each rank of those below has some rows.
class SupernodalFactor : public CholeskyFactor {
 public:
  explicit SupernodalFactor(MPI_Comm comm);
  ~SupernodalFactor() override;

  void analyze(Mat A) override;
  /// The same with a known order of elimination.
  /// @param places  [n] wanted place of each row, on all ranks
  void analyze(Mat A, const std::vector<int>& places);
  void factorize(Mat A) override;
  MatFactorError error() const override { return error_; }
  PetscInt n_negative_pivots() const override { return n_negative_; }
  bool is_reliable() const override;
  /// Eliminates a matrix A of the analysed pattern and of any inertia. A factor that is kept stays
  /// as it is.
  /// @param size_of_diagonal  sums of the absolute terms of each A_ii
  /// @note   Collective.
  PivotSigns pivot_signs(Mat A, Vec size_of_diagonal) const;
  const AssemblyTree& tree() const { return tree_; }
  /// Number of stored entries of the analysed matrix.
  double n_entries() const { return n_entries_; }
  void release() override { tiles_.reset(); }
  /// All columns; `solve` groups them itself.
  PetscInt columns_at_a_time() const override { return std::numeric_limits<int>::max(); }
  void solve(LocalColumns X) override { solve(whole_, X); }
  /// The data to solve for some rows alone.
  /// @param rows  of the matrix; ascending on each rank, which owns them
  /// @note   Collective.
  /// @throws chladni::Error when other rows are coupled to these.
  SupernodalPart part(IS rows) const;
  /// X <- A^-1 X for the rows of a part alone.
  void solve(const SupernodalPart& part, LocalColumns X);
  void solve(const SparseColumns& B, LocalColumns X) override;
  /// X <- D^(-1/2) L^-1 X for a positive definite matrix, in the order of its rows.
  void solve_half(LocalColumns X) { solve_half(whole_, X); }
  /// The same for the rows of a part alone.
  void solve_half(const SupernodalPart& part, LocalColumns X);
  Memory forecast() const override;
  FactorSize size() const override;
  std::string description() const override;

 private:
  static constexpr PetscInt most_columns = 32;

  double peak_of_fronts() const;
  void number_trees();
  void number_slots();
  int supernode_at(int position) const;
  int supernode_of_row(PetscInt row) const;
  void make_groups();
  void free_groups();
  int level_of(int s) const;
  bool is_shared(int s) const { return group_[s].size() > 1; }
  bool is_counted_here(int s) const { return group_[s].first == rank_; }
  Supernodes of_trees(const std::vector<char>& roots) const;
  SlotExchange exchange_of(const std::vector<int>& own_rows, const Supernodes& supernodes) const;
  /// What uses the columns of a supernode after its elimination, by one rank or by a group.
  struct Visit {
    std::function<void(const Fronts& fronts, int s)> own;
    std::function<void(const DealtFront& front, int s)> shared;
  };
  struct Eliminated {
    MatFactorError error;
    PetscInt n_negative = 0;
  };
  Eliminated eliminate(Mat A, const Visit& visit) const;
  int eliminate_own(Fronts& fronts, const Visit& visit) const;
  int eliminate_shared(Fronts& fronts, const MatrixRows& A, const Visit& visit) const;
  void add_squares(const Fronts& fronts, int s, std::vector<double>& sums) const;
  void add_own_squares(const DealtFront& front, int s, std::vector<double>& sums) const;
  std::vector<std::vector<int>> trees_of(const SparseColumns& B) const;
  std::vector<char> take(const SparseColumns& B, const std::vector<int>& columns,
                         Panels block) const;
  std::vector<int> trees_of_own_rows() const;
  /// Right-hand sides with few entries, and the trees that each of them and each own row is in.
  struct SparseProblem {
    SparseColumns B;
    std::vector<std::vector<int>> trees;
    std::vector<int> tree_of_row;
  };
  void solve_block(const SparseProblem& problem, const std::vector<int>& columns, LocalColumns X);
  void sum_slots(int s, Panels X) const;
  std::vector<char> active_supernodes(Panels X, const Supernodes& trees) const;
  void sweep_forward(Panels X, const Supernodes& trees, const std::vector<char>& is_active) const;
  void sweep(Panels X, const Supernodes& trees, const std::vector<char>& is_active) const;
  template <typename Sweep>
  void in_panels(const SlotExchange& exchange, LocalColumns X, const Sweep& sweep);
  TiledColumns tiles(int s) const;
  DealtRows dealt_rows(int s) const { return linear::dealt_rows(tree_, s, group_[s]); }
  SharedColumns shared_columns(int s) const;
  std::span<const int> below_slots(int s) const;
  Panels panels(std::size_t n_columns);

  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0;
  MatFactorError error_ = MAT_FACTOR_NOERROR;
  PetscInt n_negative_ = 0;
  AssemblyTree tree_;
  std::vector<RankGroup> group_;          ///< [n_supernodes] ranks that eliminate it
  std::vector<RankGroup> groups_;         ///< of this rank with others, smallest first
  std::vector<MPI_Comm> group_comms_;     ///< [groups of this rank]
  std::vector<int> tree_of_;              ///< [n_supernodes] root of its tree
  std::vector<int> slot_;                 ///< [n places] row of the panels; -1: not here
  int n_slots_ = 0;                       ///< own slots, then shared ones
  std::vector<std::size_t> tile_starts_;  ///< [n_supernodes + 1]
  std::vector<int> below_slots_;          ///< for all below_rows of the tree
  AlignedNumbers tiles_, panel_values_;
  SupernodalPart whole_;
  PetscInt first_row_ = 0, last_row_ = 0;  ///< of the matrix that this rank owns, and behind them
  double n_entries_ = 0.0;
  /// Approximate number of entries in the rows gathered from other ranks.
  double n_gathered_ = 0.0;
};

}  // namespace chladni::linear
