#pragma once

#include "plate/dofs/follow_references.hpp"

namespace chladni::plate {

/// Active nodes, those that have DOFs, are numbered so that each rank owns a contiguous range.
struct NumberedNodes : CoupledNodes {
  std::vector<int> numbers;        ///< [n] -1 where the node has no DOFs of its own
  std::vector<int> first_numbers;  ///< [n_ranks + 1] of each rank

  int number(int node) const { return numbers[node]; }
  int first_number(int rank) const { return first_numbers[rank]; }
  int n_active() const { return first_numbers.back(); }
};

/// A reference node belongs to the lowest rank among its dependents.
/// @param owners  [n_mesh_nodes] rank of each
NumberedNodes number_nodes(CoupledNodes coupled, std::span<const Coupling> couplings,
                           std::span<const int> owners, int n_ranks);

}  // namespace chladni::plate
