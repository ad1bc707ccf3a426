#pragma once

#include <map>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/refinement/lattice.hpp"

namespace chladni::plate {

/// Finds where element edges are cut: in the middle, or nearer to a free edge of the shell if one
/// end of the edge lies on it.
class EdgeCuts {
 public:
  /// @param rows  [n_nodes] m, wanted distance of the cut from a free edge at each node; or empty
  EdgeCuts(const mesh::Mesh& mesh, const std::vector<double>& rows);

  /// The place of the cut, at t in (0, 1) along the edge.
  /// @param edge  its nodes from end to end
  double cut(const std::vector<int>& edge) const;
  /// The cuts of all edges of an element.
  Cuts cuts(const mesh::ElementBlock& block, int element) const;

 private:
  const mesh::Mesh& mesh_;
  const std::vector<double>& rows_;
  std::vector<char> is_free_;  ///< [n_nodes] true at the ends of edges with one element
  std::map<std::vector<int>, int> n_elements_;  ///< of each edge, its nodes ascending
};

}  // namespace chladni::plate
