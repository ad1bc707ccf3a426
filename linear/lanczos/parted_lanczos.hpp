#pragma once

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "linear/lanczos/block_lanczos.hpp"

namespace chladni::linear {

/// Rows that K and M couple to no others, with a solver for them.
struct DecoupledPart {
  petsc::IndexSet rows;  ///< global, on the rank that owns them, ascending
  BlockSolve solve;      ///< with K between these rows, where it is not singular
  /// number of pairs at most; fewer than rows if K is singular or some of them are held
  PetscInt most = std::numeric_limits<PetscInt>::max();
};

/// The lowest pairs of K x = lambda M x if K and M consist of uncoupled parts, with a BlockLanczos
/// for each part. Vectors are as long as their part, and each part computes as many pairs as it has
/// in the range. If parts share an eigenvalue, each has its own vectors. A part without mass, or of
/// which most = 0, has no pairs.
class PartedLanczos {
 public:
  /// @param parts    together all rows of M, each row in one part
  /// @param options  without n_pairs
  /// @note   Collective.
  PartedLanczos(std::vector<DecoupledPart> parts, Mat M, const BlockLanczosOptions& options);
  /// Treats all rows as one part.
  /// @param most  number of pairs at most, as in DecoupledPart
  PartedLanczos(BlockSolve solve, PetscInt most, Mat M, const BlockLanczosOptions& options);
  PartedLanczos(Mat factor, Mat M, const BlockLanczosOptions& options);

  /// The functions below are those of BlockLanczos; `converge_beyond` finds one pair beyond lambda
  /// in each part, as far as it has some.
  void converge(PetscInt n_pairs);
  void converge_beyond(double lambda);
  void require_resolved(double lambda) const;
  double unresolved_from() const;
  PetscInt n_pairs() const { return static_cast<PetscInt>(pairs_.size()); }
  PetscInt n_solves() const;
  double lambda(PetscInt i) const { return pairs_[i].lambda; }
  petsc::Matrix vectors(PetscInt first, PetscInt last) const;

  /// True if there are no others than the pairs that have been found.
  bool has_all() const;

  PetscInt n_parts() const { return static_cast<PetscInt>(parts_.size()); }
  /// The sum over all parts of columns solved times rows.
  double numbers_solved() const;

 private:
  struct Part {
    std::vector<PetscInt> rows;  ///< local, in M; unused where this is the only part
    PetscInt n_rows = 0;         ///< on all ranks
    PetscInt most = 0;           ///< pairs
    petsc::Matrix M;             ///< null where this is the only part
    std::unique_ptr<BlockLanczos> lanczos;
    PetscInt n_asked = 0;
    bool has_all() const { return lanczos->n_pairs() < n_asked || n_asked >= most; }
    double last() const { return lanczos->lambda(lanczos->n_pairs() - 1); }
  };
  struct Pair {
    double lambda;
    std::size_t part;
    /// place among the pairs of the part
    PetscInt place;
  };

  void converge(Part& part, PetscInt n_pairs);
  PetscInt first_guess(const Part& part, PetscInt n_pairs) const;
  void converge_further(PetscInt n_pairs);
  void merge(PetscInt n_pairs);
  PetscInt n_complete() const;
  double expected_end(PetscInt n_pairs) const;

  Mat M_;
  std::string scratch_;
  std::vector<Part> parts_;
  std::vector<Pair> pairs_;  ///< ascending
};

}  // namespace chladni::linear
