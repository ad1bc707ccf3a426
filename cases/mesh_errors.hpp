#pragma once

#include <Eigen/Core>

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "cases/fe_solution.hpp"
#include "linear/solver_options.hpp"
#include "mbs_export/certificate.hpp"
#include "plate/refinement/refined_mesh.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::cases {

/// The share of an element of the mesh in the errors.
struct ErrorShare {
  std::array<double, 3> x;  ///< m, its middle
  double area;              ///< m^2
  double size;              ///< m, of its sides
  double share;  ///< of the largest error; those of other modes count in proportion to theirs
};

/// Natural frequencies of a supported model, and their estimated errors by the mesh: the distance
/// from those of the plate theory on the geometry of the elements.
struct MeshErrors {
  Eigen::VectorXd omega;   ///< [k] of the elastic modes, ascending; rad/s
  Eigen::VectorXd errors;  ///< [k] estimated relative errors of omega, without sign
  /// [6 x k] relative errors of the radial, circumferential and axial displacements of the
  /// interface nodes about the z axis, and of their rotations about these directions, as root mean
  /// squares in a mode of unit modal mass; 0 where the mode does not move them.
  Eigen::MatrixXd shape_errors;
  Eigen::VectorXd finer;  ///< [k] rad/s, the same modes in the finer model
  /// Of the surface elements, where the mesh takes sizes at places; else empty.
  std::vector<ErrorShare> shares = {};
  /// [k] by how much each halving of the elements lowers the frequency without end, relative; empty
  /// where nothing acts on shells at single nodes (PointForces)
  Eigen::VectorXd per_halving = {};
  double halvings = 0.0;  ///< so many times `per_halving` are part of `errors`
  double largest() const { return errors.size() > 0 ? errors.maxCoeff() : 0.0; }
};

/// Estimates the errors from the frequencies of the same elements at half the size. For a large
/// model it uses elements of one order more and of one order less instead; their differences show
/// what the finer one still lacks. Each other model costs one factor and one solution for all
/// modes.
/// What acts on a shell at a single node meets a compliance that grows by the same amount with each
/// halving of the elements, so that a frequency has no limit: its error is then told against
/// elements whose nodes are a tenth of the thickness apart, below which no plate theory holds.
/// @param modes  of the model; each gets an estimate
/// @note   Collective.
MeshErrors mesh_errors(const scene::Scene& scene, const SupportedModel& model,
                       const reduce::NaturalModes& modes, const linear::SolverOptions& solver = {});

/// The growth of own compliances at the interface sets of three or more nodes, by elements of half
/// the size or, for a large model, of one order more. It costs two factors. Empty for a model with
/// rigid-body motions, for one that is too large for these, and for one sector of a body.
/// @param scene  with the supports of the body
/// @note   Collective.
mbs_export::OwnCompliances mesh_compliances(const scene::Scene& scene,
                                            const linear::SolverOptions& solver);

}  // namespace chladni::cases

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

/// What acts on shells at single nodes, and what that does to frequencies. The compliance there
/// grows by the same amount with each halving of the elements, so that nothing converges. Below
/// nodes a tenth of the thickness apart no plate theory holds: errors are told against such
/// elements.
class PointForces {
 public:
  /// @note   Collective on `comm`, as `in` is.
  PointForces(const scene::Scene& scene, const mesh::Mesh& mesh, MPI_Comm comm);

  /// The nodes of shells on which a support, spring, mass, coupling or beam acts, and on no edge of
  /// the elements there.
  const std::vector<int>& points() const { return points_; }
  /// The forces of the shells' surroundings on these nodes in modes: (K - omega^2 M) phi of the
  /// shells alone.
  /// @param motions  [6 n_nodes x k]
  /// @return [6 n_nodes x k], zero elsewhere
  Eigen::MatrixXd in(const Eigen::MatrixXd& motions, const Eigen::VectorXd& omega) const;
  /// By how much a halving lowers the frequencies of modes of unit modal mass, relative: a
  /// compliance that grows by G under a force F lowers omega by F^T G F / (2 omega).
  /// @param forces  `in` the modes
  Eigen::VectorXd lowering(const Eigen::MatrixXd& forces, const Eigen::VectorXd& omega) const;
  /// Tells errors with what such forces leave.
  /// @param per_halving  `lowering`
  /// @param by_orders    whether `found.finer` are of elements of one order more
  void add_to(MeshErrors& found, const Eigen::VectorXd& per_halving, bool by_orders) const;

 private:
  const scene::Scene& scene_;
  const mesh::Mesh& mesh_;
  std::vector<int> points_;
  std::vector<Eigen::Matrix3d> of_forces_, of_moments_;  ///< m/N, 1/(N m), G of each point
  std::optional<plate::System> shells_;
};

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
