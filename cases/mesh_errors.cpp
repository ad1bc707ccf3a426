#include "cases/mesh_errors.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "common/eigen_every.hpp"
#include "plate/assembly/recovery.hpp"
#include "plate/refinement/refined_mesh.hpp"
#include "plate/sections/profile.hpp"
#include "reduce/improved_modes.hpp"

namespace chladni::cases {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// DOFs of a model whose elements are halved, for the better estimate, at four times its size.
constexpr int most_halved = 20'000;

/// Motions of all nodes in the modes, those of the mesh and then the reference nodes.
/// @return [6 n_nodes x k]
MatrixXd mode_motions(const plate::DofMap& dofs, Mat X, Index n_modes)
{
  MatrixXd motions(6 * dofs.n_nodes(), n_modes);
  for (Index j = 0; j < n_modes; ++j) {
    Vec column = nullptr;
    petsc::check(MatDenseGetColumnVecRead(X, static_cast<PetscInt>(j), &column));
    motions.col(j) = plate::node_motions(dofs, column).transpose().reshaped();
    petsc::check(MatDenseRestoreColumnVecRead(X, static_cast<PetscInt>(j), &column));
  }
  return motions;
}

/// The rows of the motions of the nodes that are DOFs of the model.
/// @param motions  [6 n_nodes x k]
MatrixXd dof_rows(const plate::DofMap& dofs, const MatrixXd& motions,
                  const std::vector<PetscInt>& wanted)
{
  std::vector<Index> row_of(static_cast<std::size_t>(dofs.n_dofs()), -1);
  for (int node = 0; node < dofs.n_nodes(); ++node)
    for (const int c : dofs.components())
      if (const auto dof = dofs.dof(node, c)) row_of[static_cast<std::size_t>(*dof)] = 6 * node + c;
  MatrixXd rows = MatrixXd::Zero(std::ssize(wanted), motions.cols());
  for (Index i = 0; i < rows.rows(); ++i) {
    const Index row = row_of[static_cast<std::size_t>(wanted[static_cast<std::size_t>(i)])];
    if (row >= 0) rows.row(i) = motions.row(row);
  }
  return rows;
}

/// The mode of another model for each of the given ones: pairs that are most alike.
std::vector<Index> by_shapes(MatrixXd shares)
{
  std::vector<Index> mode_of(static_cast<std::size_t>(shares.rows()), 0);
  for (Index k = 0; k < shares.rows(); ++k) {
    Index shape = 0, mode = 0;
    shares.maxCoeff(&shape, &mode);
    mode_of[static_cast<std::size_t>(shape)] = mode;
    shares.row(shape).setConstant(-1.0);
    shares.col(mode).setConstant(-1.0);
  }
  return mode_of;
}

/// Root sums of squares of the radial, circumferential and axial displacements of some nodes, and
/// of their rotations about these axes; z is the axis.
/// @param motions  [6 n_nodes x k]
/// @return [6 x k]
MatrixXd sizes_at(const mesh::Mesh& mesh, const std::vector<int>& nodes, const MatrixXd& motions)
{
  MatrixXd squares = MatrixXd::Zero(6, motions.cols());
  for (const int node : nodes) {
    const auto& x = mesh.positions[static_cast<std::size_t>(node)];
    const double angle = std::atan2(x[1], x[0]);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (const int kind : {0, 3})
      squares.middleRows<3>(kind) += (turn * motions.middleRows<3>(6 * node + kind)).cwiseAbs2();
  }
  return squares.cwiseSqrt();
}

/// Nodes of the interface that two meshes have, in each of them.
struct CommonNodes {
  std::vector<int> one, other;
};

CommonNodes interface_nodes(const scene::Scene& scene, const mesh::Mesh& one,
                            const mesh::Mesh& other)
{
  std::map<std::int64_t, int> with_number;
  for (int i = 0; i < other.n_nodes(); ++i)
    with_number[other.node_numbers[static_cast<std::size_t>(i)]] = i;
  CommonNodes common;
  for (const mesh::Group& group : one.groups) {
    if (std::ranges::find(scene.interface_nodes, group.name) == scene.interface_nodes.end())
      continue;
    for (const int node : group.nodes) {
      const auto found = with_number.find(one.node_numbers[static_cast<std::size_t>(node)]);
      if (found == with_number.end()) continue;
      common.one.push_back(node);
      common.other.push_back(found->second);
    }
  }
  return common;
}

/// The relative differences of the components that a mode moves.
/// @param one, other  [6 x k]
MatrixXd differences(const MatrixXd& one, const MatrixXd& other)
{
  constexpr double still = 1e-3;  // of the largest component, and of what other modes do
  MatrixXd relative = MatrixXd::Zero(6, one.cols());
  for (Index c = 0; c < 6; ++c) {
    const auto of_kind = one.middleRows<3>(c < 3 ? 0 : 3);
    const double most = of_kind.maxCoeff();
    for (Index j = 0; j < one.cols(); ++j)
      if (one(c, j) > still * std::max(most, of_kind.col(j).maxCoeff()))
        relative(c, j) = std::abs(other(c, j) / one(c, j) - 1.0);
  }
  return relative;
}

/// Modes of a model as another starts from them.
struct KnownModes {
  const mesh::Mesh& mesh;
  const MatrixXd& motions;  ///< [6 n_nodes x k]
  Index n_rigid;
  double mu;  ///< rad^2/s^2, as improved_modes
};

/// What a refined mesh tells of the elastic modes, in the order of the known ones.
struct RefinedModes {
  VectorXd omega;   ///< [k] rad/s
  MatrixXd shapes;  ///< [6 x k] differences from the known ones
};

RefinedModes modes_on(const scene::Scene& scene, plate::RefinedMesh refined,
                      const KnownModes& known, const linear::SolverOptions& solver)
{
  const Index n_mesh = known.mesh.n_nodes();
  MatrixXd on_mesh = plate::interpolated(known.mesh, refined, known.motions);
  const SupportedModel other = assemble_supported(scene, std::move(refined.mesh));
  MatrixXd motions(6 * other.system.dofs.n_nodes(), known.motions.cols());
  motions << on_mesh, known.motions.bottomRows(known.motions.rows() - 6 * n_mesh);
  const reduce::ShapesNearModes shapes{
      .n_shapes = static_cast<int>(motions.cols()),
      .rows = [&](const auto& dofs) { return dof_rows(other.system.dofs, motions, dofs); }};
  const reduce::FreeDofs free = reduce::free_dofs(other.system.K, other.held);
  const reduce::ImprovedModes modes =
      reduce::improved_modes(other.system.K, other.system.M, free, shapes, known.mu, solver);
  std::vector<Index> mode_of = by_shapes(modes.shares);
  mode_of.erase(mode_of.begin(), mode_of.begin() + known.n_rigid);
  RefinedModes found{.omega = VectorXd(modes.lambda(mode_of)).cwiseMax(0.0).cwiseSqrt(),
                     .shapes = MatrixXd::Zero(6, std::ssize(mode_of))};
  const CommonNodes common = interface_nodes(scene, known.mesh, other.mesh);
  if (common.one.empty()) return found;
  const petsc::Matrix X = reduce::of_all_dofs(modes.X, free, other.system.K, shapes.n_shapes);
  const MatrixXd of_other =
      sizes_at(other.mesh, common.other, mode_motions(other.system.dofs, X, motions.cols()));
  const MatrixXd of_known = sizes_at(known.mesh, common.one, known.motions);
  found.shapes = differences(of_known.rightCols(std::ssize(mode_of)), of_other(every, mode_of));
  return found;
}

/// Of the finer model, from the differences to a finer and to a coarser one: they go on as a
/// geometric series, or as a slow one that is cut.
VectorXd extrapolated(const VectorXd& to_finer, const VectorXd& to_coarser)
{
  constexpr double slowest = 0.5;
  VectorXd errors = to_finer;
  for (Index i = 0; i < errors.size(); ++i)
    if (to_coarser[i] > 0.0) errors[i] /= 1.0 - std::min(to_finer[i] / to_coarser[i], slowest);
  return errors;
}

/// The modes of a refinement, in the order of those of the model.
using ModesOn = std::function<RefinedModes(plate::RefinedMesh)>;

VectorXd relative_distance(const VectorXd& omega, const VectorXd& other)
{
  return (other - omega).cwiseAbs().cwiseQuotient(omega);
}

/// The least thickness of the shells at each node: free edges have a layer of that width, where the
/// twisting moment of a thin plate becomes its shear force.
std::vector<double> thicknesses(const scene::Scene& scene, const mesh::Mesh& mesh)
{
  std::vector<double> least(mesh.positions.size(), std::numeric_limits<double>::infinity());
  for (const plate::ShellSection& section : scene.sections)
    for (const int node : mesh::find_group(mesh, section.group).nodes) {
      const auto n = static_cast<std::size_t>(node);
      least[n] = std::min(least[n], plate::value_at(section.thickness, mesh.positions[n]));
    }
  return least;
}

/// Of each mode the frequency that is further from that of the model.
VectorXd further(const VectorXd& omega, const VectorXd& one, const VectorXd& other)
{
  return ((one - omega).cwiseAbs().array() < (other - omega).cwiseAbs().array()).select(other, one);
}

/// Elements of half the size lack next to nothing where modes are smooth, and a quarter of the
/// error where it goes with the square of the size. The layer at free edges, where it is thinner
/// than half of the elements there, is asked for by elements cut at its width.
void find_by_halves(const scene::Scene& scene, const mesh::Mesh& mesh, const ModesOn& modes,
                    MeshErrors& found)
{
  constexpr double left = 0.25;
  const int order = mesh.blocks.front().order;
  RefinedModes finer = modes(plate::refined(mesh, {.parts = 2, .order = order}));
  found.finer = std::move(finer.omega);
  found.shape_errors = finer.shapes / (1.0 - left);
  const std::vector<double> rows = thicknesses(scene, mesh);
  if (plate::has_wide_edges(mesh, rows)) {
    plate::RefinedMesh cut = plate::refined(mesh, {.parts = 2, .order = order, .edge_rows = rows});
    if (plate::keeps_points(mesh, cut.mesh))
      found.finer = further(found.omega, found.finer, modes(std::move(cut)).omega);
  }
  found.errors = relative_distance(found.omega, found.finer) / (1.0 - left);
}

void find_by_orders(const mesh::Mesh& mesh, const ModesOn& modes, MeshErrors& found)
{
  const int order = mesh.blocks.front().order;
  RefinedModes finer = modes(plate::refined(mesh, {.parts = 1, .order = order + 1}));
  found.finer = std::move(finer.omega);
  found.shape_errors = std::move(finer.shapes);
  found.errors = relative_distance(found.omega, found.finer);
  if (order == 1) return;
  plate::RefinedMesh coarser = plate::refined(mesh, {.parts = 1, .order = order - 1});
  if (!plate::keeps_points(mesh, coarser.mesh)) return;
  found.errors =
      extrapolated(found.errors, relative_distance(found.omega, modes(std::move(coarser)).omega));
}

}  // namespace

MeshErrors mesh_errors(const scene::Scene& scene, const SupportedModel& model,
                       const reduce::NaturalModes& modes, const linear::SolverOptions& solver)
{
  const Index n = std::ssize(modes.lambda);
  const Index n_rigid = std::min<Index>(plate::n_free_motions(model.free), n);
  if (n == n_rigid) return {};
  MeshErrors found{.omega = VectorXd(n - n_rigid), .errors = {}, .shape_errors = {}, .finer = {}};
  for (Index i = n_rigid; i < n; ++i)
    found.omega[i - n_rigid] = std::sqrt(std::max(modes.lambda[static_cast<std::size_t>(i)], 0.0));
  const MatrixXd motions = mode_motions(model.system.dofs, modes.X, n);
  const double first = found.omega[0];
  const KnownModes known{.mesh = model.mesh,
                         .motions = motions,
                         .n_rigid = n_rigid,
                         .mu = n_rigid > 0 ? first * first : 0.0};
  const auto on = [&](plate::RefinedMesh other) {
    return modes_on(scene, std::move(other), known, solver);
  };
  const bool is_large = model.system.dofs.n_dofs() > most_halved;
  if (is_large && plate::can_rise(model.mesh))
    find_by_orders(model.mesh, on, found);
  else
    find_by_halves(scene, model.mesh, on, found);
  return found;
}

}  // namespace chladni::cases
