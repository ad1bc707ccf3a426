#include "cases/mesh_errors.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "cases/fe_model.hpp"
#include "cases/scene_mesh.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mesh/element_types.hpp"
#include "plate/assembly/recovery.hpp"
#include "plate/sections/sections.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

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
    for (const int c : dofs.components_of(node))
      if (const auto dof = dofs.dof(node, c)) row_of[static_cast<std::size_t>(*dof)] = 6 * node + c;
  MatrixXd rows = MatrixXd::Zero(std::ssize(wanted), motions.cols());
  for (Index i = 0; i < rows.rows(); ++i) {
    const Index row = row_of[static_cast<std::size_t>(wanted[static_cast<std::size_t>(i)])];
    if (row >= 0) rows.row(i) = motions.row(row);
  }
  return rows;
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

/// Components of a loaded node: displacements, and rotations across the axis.
constexpr std::array<int, 5> own_components{0, 1, 2, 3, 4};

/// Some nodes of each set of the interface on which pads may act, a node or two being no ring.
struct LoadedSets {
  std::vector<std::string> names;
  std::vector<Index> sizes;         ///< loaded nodes of each
  std::vector<std::int64_t> nodes;  ///< their numbers in the mesh, set by set
};

LoadedSets loaded_sets(const scene::Scene& scene, const mesh::Mesh& mesh)
{
  constexpr std::size_t fewest = 3, most = 4;
  LoadedSets sets;
  for (const mesh::Group& group : mesh.groups) {
    const bool is_asked =
        std::ranges::find(scene.interface_nodes, group.name) != scene.interface_nodes.end();
    if (!is_asked || group.nodes.size() < fewest) continue;
    const std::size_t n = std::min(most, group.nodes.size());
    for (std::size_t i = 0; i < n; ++i) {
      const int node = group.nodes[i * group.nodes.size() / n];
      sets.nodes.push_back(mesh.node_numbers[static_cast<std::size_t>(node)]);
    }
    sets.names.push_back(group.name);
    sets.sizes.push_back(static_cast<Index>(n));
  }
  return sets;
}

/// The displacements of the loaded DOFs of a model, node by node, each by a force of its own.
VectorXd loaded_compliances(const SupportedModel& model, const LoadedSets& loaded,
                            const linear::SolverOptions& solver)
{
  std::map<std::int64_t, int> with_number;
  for (int i = 0; i < model.mesh.n_nodes(); ++i)
    with_number[model.mesh.node_numbers[static_cast<std::size_t>(i)]] = i;
  std::vector<PetscInt> dofs;
  for (const std::int64_t number : loaded.nodes)
    for (const int c : own_components) {
      const auto node = with_number.find(number);
      const auto dof =
          node != with_number.end() ? model.system.dofs.dof(node->second, c) : std::nullopt;
      dofs.push_back(dof ? static_cast<PetscInt>(*dof) : -1);
    }
  return reduce::own_compliances(model.system.K, reduce::free_dofs(model.system.K, model.held),
                                 dofs, solver);
}

/// Modes of a model as another starts from them.
struct KnownModes {
  const mesh::Mesh& mesh;
  const MatrixXd& motions;  ///< [6 n_nodes x k]
  Index n_rigid;
  double mu;  ///< rad^2/s^2, as improved_modes
  const linear::SolverOptions& solver;
};

/// Strain energies of what known modes lack in the space of others on a finer mesh, summed over the
/// parts of each element.
/// @param known, finer  [6 n_nodes x n], of the finer mesh; columns of no interest first
/// @return [n_elements x k]
MatrixXd lacking_energies(const scene::Scene& scene, const mesh::Mesh& fine, const MatrixXd& known,
                          const MatrixXd& finer, const KnownModes& modes)
{
  const MatrixXd c = linear::least_squares(finer.transpose() * finer, finer.transpose() * known);
  const MatrixXd lacking = known - finer * c;
  const MatrixXd of_parts =
      plate::element_energies(fine, structure_of(scene),
                              lacking.rightCols(lacking.cols() - modes.n_rigid), PETSC_COMM_WORLD);
  Index n_elements = 0;
  for (const mesh::ElementBlock& block : modes.mesh.blocks) n_elements += block.n_elements();
  MatrixXd energies = MatrixXd::Zero(n_elements, of_parts.cols());
  Index element = 0, part = 0;
  for (std::size_t b = 0; b < fine.blocks.size(); ++b) {
    const int n = modes.mesh.blocks[b].n_elements();
    const int n_parts = fine.blocks[b].n_elements() / std::max(n, 1);
    for (int e = 0; e < n; ++e, ++element, part += n_parts)
      energies.row(element) = of_parts.middleRows(part, n_parts).colwise().sum();
  }
  return energies;
}

RefinedModes modes_on(const scene::Scene& scene, plate::RefinedMesh refined,
                      const KnownModes& known, Asked asked)
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
      reduce::improved_modes(other.system.K, other.system.M, free, shapes, known.mu, known.solver);
  std::vector<Index> mode_of = by_shapes(modes.shares);
  mode_of.erase(mode_of.begin(), mode_of.begin() + known.n_rigid);
  RefinedModes found{.omega = VectorXd(modes.lambda(mode_of)).cwiseMax(0.0).cwiseSqrt(),
                     .shapes = MatrixXd::Zero(6, std::ssize(mode_of))};
  const CommonNodes common = interface_nodes(scene, known.mesh, other.mesh);
  const bool asks_where = asked == Asked::where && scene.accuracy && takes_local_sizes(scene.mesh);
  if (common.one.empty() && !asks_where) return found;
  const petsc::Matrix X = reduce::of_all_dofs(modes.X, free, other.system.K, shapes.n_shapes);
  const MatrixXd of_modes = mode_motions(other.system.dofs, X, motions.cols());
  if (asks_where) found.lacking = lacking_energies(scene, other.mesh, motions, of_modes, known);
  if (common.one.empty()) return found;
  const MatrixXd of_other = sizes_at(other.mesh, common.other, of_modes);
  const MatrixXd of_known = sizes_at(known.mesh, common.one, known.motions);
  found.shapes = differences(of_known.rightCols(std::ssize(mode_of)), of_other(every, mode_of));
  return found;
}

}  // namespace

namespace {

/// Halved solids are eight times as many.
void refuse_large_solids(const SupportedModel& model)
{
  constexpr int most = 60'000;
  const int n_dofs = model.system.dofs.n_dofs();
  const bool has_solids =
      std::ranges::any_of(model.mesh.blocks, [](const auto& b) { return mesh::is_solid(b.shape); });
  if (!has_solids || n_dofs <= most || plate::can_rise(model.mesh)) return;
  throw Error(fmt::format(
      "mesh_errors: the errors of these solids come from elements of half the size, and of {} DOFs "
      "there would be about {}; estimate those of a coarser mesh of at most {} DOFs, or take "
      "mesh_errors out",
      n_dofs, 8 * std::int64_t{n_dofs}, most));
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
                         .mu = n_rigid > 0 ? first * first : 0.0,
                         .solver = solver};
  const auto on = [&](plate::RefinedMesh other, Asked asked) {
    return modes_on(scene, std::move(other), known, asked);
  };
  const bool is_large = model.system.dofs.n_dofs() > most_halved;
  refuse_large_solids(model);
  if (is_large && plate::can_rise(model.mesh))
    find_by_orders(model.mesh, on, found);
  else
    find_by_halves(scene, model.mesh, on, found);
  return found;
}

mbs_export::OwnCompliances mesh_compliances(const scene::Scene& scene,
                                            const linear::SolverOptions& solver)
{
  constexpr int most_by_orders = 10 * most_halved;
  mesh::Mesh mesh = mesh_on_all_ranks(scene);
  if (mesh.sectors.count > 1) return {};
  const SupportedModel model = assemble_supported(scene, std::move(mesh));
  const LoadedSets loaded = loaded_sets(scene, model.mesh);
  const int n_dofs = model.system.dofs.n_dofs(), order = model.mesh.blocks.front().order;
  const bool by_orders = n_dofs > most_halved;
  const bool has_solids = std::ranges::any_of(
      model.mesh.blocks, [](const auto& block) { return mesh::is_solid(block.shape); });
  if (loaded.names.empty() || has_solids || !model.free.empty() || n_dofs > most_by_orders ||
      (by_orders && !plate::can_rise(model.mesh)))
    return {};
  const SupportedModel finer = assemble_supported(
      scene, plate::refined(model.mesh,
                            {.parts = by_orders ? 1 : 2, .order = by_orders ? order + 1 : order})
                 .mesh);
  // With elements of one order more nodes are nearer to each other by this power of two.
  const double halvings = by_orders ? std::log2(1.0 + 1.0 / order) : 1.0;
  const VectorXd growth =
      (loaded_compliances(finer, loaded, solver) - loaded_compliances(model, loaded, solver)) /
      halvings;
  mbs_export::OwnCompliances own{.sets = loaded.names,
                                 .growth = MatrixXd::Zero(3, std::ssize(loaded.names))};
  Index row = 0;
  for (Index s = 0; s < own.growth.cols(); ++s) {
    const Index n = loaded.sizes[static_cast<std::size_t>(s)];
    for (Index i = 0; i < n; ++i, row += std::ssize(own_components)) {
      const VectorXd of_node = growth.segment(row, std::ssize(own_components)).cwiseAbs();
      own.growth.col(s) += Eigen::Vector3d{of_node[2], 0.5 * (of_node[0] + of_node[1]),
                                           0.5 * (of_node[3] + of_node[4])} /
                           double(n);
    }
  }
  return own;
}

namespace {

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

/// Where an element is, and how large.
ErrorShare place_of(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                    const mesh::LatticeCell& corners)
{
  const std::span<const int> nodes = block.element_nodes(element);
  std::array<Eigen::Vector3d, 4> at;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const int node = nodes[static_cast<std::size_t>(corners[i])];
    at[i] =
        Eigen::Map<const Eigen::Vector3d>(mesh.positions[static_cast<std::size_t>(node)].data());
  }
  const bool is_triangle = corners[2] == corners[3];
  const Eigen::Vector3d sum = at[0] + at[1] + at[2] + at[3];
  const Eigen::Vector3d middle = is_triangle ? Eigen::Vector3d((sum - at[3]) / 3.0) : sum / 4.0;
  const double area = 0.5 * (at[2] - at[0]).cross(at[3] - at[1]).norm();
  return {
      .x = {middle[0], middle[1], middle[2]},
      .area = area,
      .size = std::sqrt(is_triangle ? 2.0 * area : area),  // two triangles are one quadrilateral
      .share = 0.0};
}

/// Of each mode the frequency that is further from that of the model.
VectorXd further(const VectorXd& omega, const VectorXd& one, const VectorXd& other)
{
  return ((one - omega).cwiseAbs().array() < (other - omega).cwiseAbs().array()).select(other, one);
}

}  // namespace

void find_by_halves(const scene::Scene& scene, const mesh::Mesh& mesh, const ModesOn& modes,
                    MeshErrors& found)
{
  constexpr double left = 0.25;
  const int order = mesh.blocks.front().order;
  RefinedModes finer = modes(plate::refined(mesh, {.parts = 2, .order = order}), Asked::where);
  found.finer = std::move(finer.omega);
  found.shape_errors = finer.shapes / (1.0 - left);
  const MatrixXd lacking = std::move(finer.lacking);
  const std::vector<double> rows = thicknesses(scene, mesh);
  if (plate::has_wide_edges(mesh, rows)) {
    plate::RefinedMesh cut = plate::refined(mesh, {.parts = 2, .order = order, .edge_rows = rows});
    if (plate::keeps_points(mesh, cut.mesh))
      found.finer = further(found.omega, found.finer, modes(std::move(cut), Asked::nothing).omega);
  }
  found.errors = relative_distance(found.omega, found.finer) / (1.0 - left);
  found.shares = error_shares(mesh, lacking, found.errors);
}

void find_by_orders(const mesh::Mesh& mesh, const ModesOn& modes, MeshErrors& found)
{
  const int order = mesh.blocks.front().order;
  RefinedModes finer = modes(plate::refined(mesh, {.parts = 1, .order = order + 1}), Asked::where);
  found.finer = std::move(finer.omega);
  found.shape_errors = std::move(finer.shapes);
  found.errors = relative_distance(found.omega, found.finer);
  if (order > 1) {
    plate::RefinedMesh coarser = plate::refined(mesh, {.parts = 1, .order = order - 1});
    if (plate::keeps_points(mesh, coarser.mesh)) {
      found.errors = extrapolated(
          found.errors,
          relative_distance(found.omega, modes(std::move(coarser), Asked::nothing).omega));
    }
  }
  found.shares = error_shares(mesh, finer.lacking, found.errors);
}

std::vector<ErrorShare> error_shares(const mesh::Mesh& mesh, const MatrixXd& lacking,
                                     const VectorXd& errors)
{
  std::vector<ErrorShare> shares;
  if (lacking.size() == 0 || errors.maxCoeff() <= 0.0) return shares;
  // What the energies of a mode count.
  const VectorXd sums = lacking.colwise().sum().transpose().cwiseMax(1e-300);
  const VectorXd weights = errors.cwiseQuotient(sums) / errors.maxCoeff();
  constexpr double much = 0.1;  // of the largest error
  Index row = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    const Index first = row;
    row += block.n_elements();
    if (block.shape == mesh::Shape::line) {
      const VectorXd of_lines =
          lacking.middleRows(first, block.n_elements()).colwise().sum().transpose();
      if (of_lines.cwiseProduct(weights).maxCoeff() > much) return {};
      continue;
    }
    const mesh::LatticeCell corners = mesh::lattice_cells(block, block.order).front();
    for (int e = 0; e < block.n_elements(); ++e) {
      shares.push_back(place_of(mesh, block, e, corners));
      shares.back().share = lacking.row(first + e).transpose().cwiseProduct(weights).maxCoeff();
    }
  }
  return shares;
}

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

}  // namespace chladni::cases
