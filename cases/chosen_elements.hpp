#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// An element and the first of its points.
struct ChosenElement {
  const mesh::ElementBlock& block;
  int element;
  Eigen::Index first_point;
};

/// Elements of one group of the mesh.
struct Chosen {
  std::string group;
  std::vector<ChosenElement> elements;
  std::vector<int> nodes;  ///< ascending
  Eigen::Index n_points = 0;
};

/// Those of the group that the choice names, or all.
/// @param points_of  how many points an element of the block has; none leaves it out
/// @throws chladni::Error when none is left.
Chosen choose_elements(const mesh::Mesh& mesh, const std::string& group,
                       const scene::ResultantChoice& choice,
                       const std::function<Eigen::Index(const mesh::ElementBlock&)>& points_of);

/// The rows of its nodes.
/// @param rows  [6 n_nodes x n] of Chosen::nodes
/// @return [6 n_e x n]
Eigen::MatrixXd rows_of_element(const Chosen& chosen, const ChosenElement& element,
                                const Eigen::MatrixXd& rows);

}  // namespace chladni::cases
