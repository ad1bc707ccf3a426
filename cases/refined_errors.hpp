#pragma once

#include <functional>
#include <vector>

#include "cases/mesh_errors.hpp"
#include "plate/refinement/refined_mesh.hpp"

/// The errors of a mesh as found by refined meshes, independent of who solves for their modes.
namespace chladni::cases {

/// The elastic modes on a refined mesh, in the order of the known ones.
struct RefinedModes {
  Eigen::VectorXd omega;   ///< [k] rad/s
  Eigen::MatrixXd shapes;  ///< [6 x k] differences from the known ones
  /// [n_elements x k] strain energies of what the known modes lack, by the elements of the mesh;
  /// empty where nobody asks for them
  Eigen::MatrixXd lacking = {};
};

/// What is asked of a refined mesh besides its frequencies.
enum class Asked { nothing, where };

/// Returns the modes on a refined mesh, in the order of those of the model.
using ModesOn = std::function<RefinedModes(plate::RefinedMesh, Asked)>;

/// The largest number of DOFs of a model whose elements are halved. This estimate is better than
/// that by orders, but its model is four times as large.
constexpr int most_halved = 20'000;

/// Estimates errors with elements of half the size. Their error is negligible where modes are
/// smooth, and a quarter of the error where it is of second order in the size. A boundary layer at
/// free edges that is thinner than half of the elements there is resolved by elements cut at its
/// width.
/// @param found  with the frequencies of the mesh
void find_by_halves(const scene::Scene& scene, const mesh::Mesh& mesh, const ModesOn& modes,
                    MeshErrors& found);

/// Estimates errors with elements of one order more and, if possible, of one order less.
/// @param found  with the frequencies of the mesh
void find_by_orders(const mesh::Mesh& mesh, const ModesOn& modes, MeshErrors& found);

/// The shares of the surface elements in the errors of the frequencies.
/// @param lacking  RefinedModes::lacking
/// @param errors   [k] of the frequencies
/// @return empty where beams have much of an error, which smaller shells do not cure
std::vector<ErrorShare> error_shares(const mesh::Mesh& mesh, const Eigen::MatrixXd& lacking,
                                     const Eigen::VectorXd& errors);

/// The mode of another model that corresponds to each given mode, by the pairs of most similar
/// shapes.
/// @param shares  [n x m] share of mode i in the other mode j, m >= n
std::vector<Eigen::Index> by_shapes(Eigen::MatrixXd shares);

/// The relative differences of the components that a mode moves.
/// @param one, other  [6 x k]
Eigen::MatrixXd differences(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other);

}  // namespace chladni::cases
