#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "linear/lanczos/block_lanczos.hpp"

namespace chladni::linear {

/// Rows that K and M couple to no others, with what solves for them.
struct DecoupledPart {
  petsc::IndexSet rows;  ///< global, on the rank that owns them, ascending
  BlockSolve solve;      ///< with K between these rows
};

/// The lowest pairs of K x = lambda M x where K and M fall into parts that are not coupled, by a
/// BlockLanczos for each part: vectors are as short as their part, and each part takes as many as
/// it has pairs in the range. Of equal eigenvalues in several parts each has its own vectors. A
/// part without mass has none.
class PartedLanczos {
 public:
  /// @param parts    all rows of M, each in one part
  /// @param options  all but n_pairs
  /// @note   Collective.
  PartedLanczos(std::vector<DecoupledPart> parts, Mat M, const BlockLanczosOptions& options);
  /// All of one part.
  PartedLanczos(Mat factor, Mat M, const BlockLanczosOptions& options);

  /// As those of BlockLanczos.
  void converge(PetscInt n_pairs);
  void require_resolved(double lambda) const;
  double unresolved_from() const;
  PetscInt n_pairs() const { return static_cast<PetscInt>(pairs_.size()); }
  PetscInt n_solves() const;
  double lambda(PetscInt i) const { return pairs_[i].lambda; }
  petsc::Matrix vectors(PetscInt first, PetscInt last) const;

  PetscInt n_parts() const { return static_cast<PetscInt>(parts_.size()); }
  /// Columns solved times the rows of their part.
  double numbers_solved() const;

 private:
  struct Part {
    std::vector<PetscInt> rows;  ///< local, in M; unused where it is the only one
    PetscInt n_rows = 0;         ///< of all ranks
    petsc::Matrix M;
    std::unique_ptr<BlockLanczos> lanczos;
    PetscInt n_asked = 0;
    bool has_all() const { return lanczos->n_pairs() < n_asked || n_asked >= n_rows; }
    double last() const { return lanczos->lambda(lanczos->n_pairs() - 1); }
  };
  struct Pair {
    double lambda;
    std::size_t part;
    PetscInt place;  ///< among those of the part
  };

  void converge(Part& part, PetscInt n_pairs);
  PetscInt first_guess(const Part& part, PetscInt n_pairs) const;
  void converge_further(PetscInt n_pairs);
  void merge(PetscInt n_pairs);
  PetscInt n_complete() const;
  double expected_end(PetscInt n_pairs) const;

  Mat M_;
  std::vector<Part> parts_;
  std::vector<Pair> pairs_;  ///< ascending
};

}  // namespace chladni::linear
