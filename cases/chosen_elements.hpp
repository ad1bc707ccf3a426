#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// An element and the index of the first of its points.
struct ChosenElement {
  const mesh::ElementBlock& block;
  int element;
  Eigen::Index first_point;
};

/// The chosen elements of one group of the mesh.
struct Chosen {
  std::string group;
  std::vector<ChosenElement> elements;
  std::vector<int> nodes;  ///< ascending
  Eigen::Index n_points = 0;
};

/// The elements of the group that the choice names, or all of them.
/// @param points_of  number of points of an element of the block; elements with none are left out
/// @throws chladni::Error when no element is left.
Chosen choose_elements(const mesh::Mesh& mesh, const std::string& group,
                       const scene::ResultantChoice& choice,
                       const std::function<Eigen::Index(const mesh::ElementBlock&)>& points_of);

/// The rows of the nodes of an element.
/// @param rows  [6 n_nodes x n] for Chosen::nodes
/// @return [6 n_e x n]
Eigen::MatrixXd rows_of_element(const Chosen& chosen, const ChosenElement& element,
                                const Eigen::MatrixXd& rows);

}  // namespace chladni::cases
