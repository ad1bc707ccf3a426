#pragma once

#include "plate/dofs/follow_references.hpp"

namespace chladni::plate {

/// Nodes with numbers for the active ones, those that have DOFs. Each rank owns a contiguous range.
struct NumberedNodes : CoupledNodes {
  std::vector<int> numbers;        ///< [n] -1 where the node has no DOFs of its own
  std::vector<int> first_numbers;  ///< [n_ranks + 1] first number of each rank

  int number(int node) const { return numbers[node]; }
  int first_number(int rank) const { return first_numbers[rank]; }
  int n_active() const { return first_numbers.back(); }
};

/// Numbers the active nodes. A reference node belongs to the lowest rank among its dependents.
/// @param owners  [n_mesh_nodes] rank of each node of the mesh
NumberedNodes number_nodes(CoupledNodes coupled, std::span<const Coupling> couplings,
                           std::span<const int> owners, int n_ranks);

}  // namespace chladni::plate
