#pragma once

#include <string>
#include <vector>

#include "linear/cholesky/cholesky_factor.hpp"
#include "linear/cholesky/supernodal/assembly_tree.hpp"
#include "linear/cholesky/supernodal/fronts.hpp"
#include "linear/cholesky/supernodal/slot_exchange.hpp"
#include "linear/cholesky/supernodal/tiled_columns.hpp"
#include "linear/kernels/aligned_numbers.hpp"

namespace chladni::linear {

/// Sparse factor L D L^T of our own for many right-hand sides: nested dissection by METIS,
/// multifrontal elimination without pivoting, and triangular solutions that read the factor as it
/// stands in memory, tile by tile, once for all columns of a block. Whole subtrees belong to one
/// rank; what stands above them is small for plates and shells and is repeated on all.
class SupernodalFactor : public CholeskyFactor {
 public:
  explicit SupernodalFactor(MPI_Comm comm);
  ~SupernodalFactor() override;

  void analyze(Mat A) override;
  void factorize(Mat A) override;
  MatFactorError error() const override { return error_; }
  PetscInt n_negative_pivots() const override { return n_negative_; }
  bool is_reliable() const override;
  void release() override { tiles_.reset(); }
  PetscInt columns_at_a_time() const override { return most_columns; }
  void solve(LocalColumns X) override;
  void solve(const SparseColumns& B, LocalColumns X) override;
  Memory forecast() const override;
  FactorSize size() const override;
  std::string description() const override;

 private:
  static constexpr PetscInt most_columns = 64;

  void number_slots();
  void eliminate(Mat A);
  int eliminate_own(Fronts& fronts);
  int eliminate_common(Fronts& fronts, int s);
  void keep(const Fronts& fronts, int s);
  std::vector<char> take(const SparseColumns& B, int first, Panels panels) const;
  void sweep(Panels X, const std::vector<char>& is_active) const;
  TiledColumns tiles(int s) const;
  Panels panels(int n_columns);

  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0;
  MatFactorError error_ = MAT_FACTOR_NOERROR;
  PetscInt n_negative_ = 0;
  AssemblyTree tree_;
  std::vector<int> owner_;                ///< [n_supernodes] a rank or all_ranks
  std::vector<int> own_, common_;         ///< supernodes of this rank alone, of all ranks
  std::vector<int> slot_;                 ///< [n positions] row of the panels, -1: not here
  int n_own_slots_ = 0, n_slots_ = 0;     ///< those of all ranks behind the own ones
  std::vector<std::size_t> tile_starts_;  ///< [n_supernodes + 1]
  std::vector<int> below_slots_;          ///< of all below_rows of the tree
  AlignedNumbers tiles_, panel_values_;
  SlotExchange exchange_;
  double n_gathered_ = 0.0;  ///< entries of the rows that are gathered from other ranks, about
};

}  // namespace chladni::linear
