#pragma once

#include <map>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/refinement/lattice.hpp"

namespace chladni::plate {

/// Where the edges of elements are cut: in the middle, or nearer to a free edge of the shell that
/// they meet at one end.
class EdgeCuts {
 public:
  /// @param rows  [n_nodes] m, the distance of the cut from a free edge at that node; or empty
  EdgeCuts(const mesh::Mesh& mesh, const std::vector<double>& rows);

  /// At t in (0, 1) of the edge.
  /// @param edge  its nodes from end to end
  double cut(const std::vector<int>& edge) const;
  /// Of all edges of an element.
  Cuts cuts(const mesh::ElementBlock& block, int element) const;

 private:
  const mesh::Mesh& mesh_;
  const std::vector<double>& rows_;
  std::vector<char> is_free_;                   ///< [n_nodes] end of an edge of one element
  std::map<std::vector<int>, int> n_elements_;  ///< of each edge, its nodes ascending
};

}  // namespace chladni::plate
