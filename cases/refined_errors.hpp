#pragma once

#include <functional>
#include <vector>

#include "cases/mesh_errors.hpp"
#include "plate/refinement/refined_mesh.hpp"

/// What refined meshes tell of the errors of a mesh, whoever solves for their modes.
namespace chladni::cases {

/// What a refined mesh tells of the elastic modes, in the order of the known ones.
struct RefinedModes {
  Eigen::VectorXd omega;   ///< [k] rad/s
  Eigen::MatrixXd shapes;  ///< [6 x k] differences from the known ones
};

/// The modes of a refinement, in the order of those of the model.
using ModesOn = std::function<RefinedModes(plate::RefinedMesh)>;

/// DOFs of a model whose elements are halved, for the better estimate, at four times its size.
constexpr int most_halved = 20'000;

/// Elements of half the size lack next to nothing where modes are smooth, and a quarter of the
/// error where it goes with the square of the size. The layer at free edges, where it is thinner
/// than half of the elements there, is asked for by elements cut at its width.
/// @param found  with the frequencies of the mesh
void find_by_halves(const scene::Scene& scene, const mesh::Mesh& mesh, const ModesOn& modes,
                    MeshErrors& found);

/// From elements of one order more and, where they can, of one order less.
/// @param found  with the frequencies of the mesh
void find_by_orders(const mesh::Mesh& mesh, const ModesOn& modes, MeshErrors& found);

/// The mode of another model for each of the given ones: pairs that are most alike.
/// @param shares  [n x m] of mode i in the other mode j, m >= n
std::vector<Eigen::Index> by_shapes(Eigen::MatrixXd shares);

/// The relative differences of the components that a mode moves.
/// @param one, other  [6 x k]
Eigen::MatrixXd differences(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other);

}  // namespace chladni::cases
