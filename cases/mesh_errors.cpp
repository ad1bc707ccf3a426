#include "cases/mesh_errors.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <span>

#include "cases/fe_model.hpp"
#include "cases/scene_mesh.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "mesh/element_types.hpp"
#include "mesh/partition.hpp"
#include "plate/assembly/assemble.hpp"
#include "plate/assembly/recovery.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/dofs/drilling.hpp"
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

/// Marks nodes of shells that something acts on, and those of them where it acts along an edge.
class ActedOn {
 public:
  explicit ActedOn(const mesh::Mesh& mesh)
      : mesh_(mesh),
        is_shell_(plate::nodes_on_surfaces(mesh)),
        acts_(is_shell_.size(), 0),
        along_edge_(acts_)
  {}

  void add(const std::vector<int>& nodes, bool has_edges)
  {
    std::vector<char> is_in(acts_.size(), 0);
    for (const int node : nodes) is_in[std::size_t(node)] = acts_[std::size_t(node)] = 1;
    if (!has_edges) return;
    const auto acts = [&](int node) { return is_in[std::size_t(node)] != 0; };
    for (const mesh::ElementBlock& block : mesh_.blocks) {
      for (int e = 0; mesh::is_surface(block.shape) && e < block.n_elements(); ++e)
        for (const std::vector<int>& edge : mesh::edges_of(block, e))
          if (std::ranges::all_of(edge, acts))
            for (const int node : edge) along_edge_[std::size_t(node)] = 1;
    }
  }

  /// Groups of points have no edges, also where two of their nodes are neighbours.
  void add(const std::string& name)
  {
    const auto group = std::ranges::find(mesh_.groups, name, &mesh::Group::name);
    if (group != mesh_.groups.end()) add(group->nodes, group->dimension > 0);
  }

  std::vector<int> points() const
  {
    std::vector<int> nodes;
    for (std::size_t i = 0; i < acts_.size(); ++i)
      if (is_shell_[i] != 0 && acts_[i] != 0 && along_edge_[i] == 0) nodes.push_back(int(i));
    return nodes;
  }

 private:
  const mesh::Mesh& mesh_;
  std::vector<char> is_shell_, acts_, along_edge_;
};

std::vector<int> acted_on_at_points(const scene::Scene& scene, const mesh::Mesh& mesh)
{
  ActedOn acted(mesh);
  for (const plate::Support& support : scene.supports) acted.add(support.group);
  for (const plate::PointMass& mass : scene.masses) acted.add(mass.at);
  for (const plate::Spring& spring : scene.springs) {
    acted.add(spring.at);
    acted.add(spring.to.value_or(""));
  }
  for (const plate::Coupling& coupling : scene.couplings) {
    acted.add(coupling.group);
    acted.add(coupling.to);
  }
  for (const mesh::ElementBlock& block : mesh.blocks)
    if (block.shape == mesh::Shape::line) acted.add(block.nodes, true);
  return acted.points();
}

/// The shells of a mesh by themselves: nothing holds them, and nothing hangs on them.
plate::System shells_alone(const scene::Scene& scene, const mesh::Mesh& mesh, MPI_Comm comm)
{
  mesh::Mesh shells = mesh;
  std::erase_if(shells.blocks, [](const auto& block) { return !mesh::is_surface(block.shape); });
  shells.face_nodes.clear();
  std::vector<char> has_element(shells.positions.size(), 0);
  for (const mesh::ElementBlock& block : shells.blocks)
    for (const int node : block.nodes) has_element[std::size_t(node)] = 1;
  std::vector<int> owners = mesh::node_owners(shells, petsc::size(comm));
  for (std::size_t i = 0; i < owners.size(); ++i)
    if (has_element[i] == 0) owners[i] = -1;
  plate::DofMap dofs =
      plate::make_dof_map(shells, {.components = scene.components}, owners, petsc::size(comm));
  return plate::assemble(shells, scene.sections, std::move(dofs), comm);
}

/// Motions or forces of nodes as vectors of a system.
/// @param of_nodes  [6 n_nodes x k]
petsc::Matrix as_vectors(const plate::System& system, const MatrixXd& of_nodes)
{
  petsc::Matrix X = linear::uninitialized_dense(system.K, of_nodes.cols());
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(system.K, &first, &last));
  std::vector<PetscInt> own(std::size_t(last - first));
  std::iota(own.begin(), own.end(), first);
  const MatrixXd rows = dof_rows(system.dofs, of_nodes, own);
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(X, &values));
  std::copy_n(rows.data(), rows.size(), values);
  petsc::check(MatDenseRestoreArrayWrite(X, &values));
  return X;
}

/// The integral of e e^T over the directions e into an element from one of its nodes.
Eigen::Matrix3d directions(const mesh::FaceAtNode& face)
{
  const auto vector = [](const mesh::Vector& v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
  const Eigen::Vector3d n = vector(face.normal);
  if (face.edges.empty())
    return std::numbers::pi * (Eigen::Matrix3d::Identity() - n * n.transpose());
  const Eigen::Vector3d middle =
      face.edges.size() == 1
          ? vector(face.edges[0].inward)
          : (vector(face.edges[0].along) + vector(face.edges[1].along)).normalized();
  const Eigen::Vector3d across = n.cross(middle);
  return 0.5 * (face.angle + std::sin(face.angle)) * middle * middle.transpose() +
         0.5 * (face.angle - std::sin(face.angle)) * across * across.transpose();
}

/// What resists a force or moment at a node within elements: f = S u / ln(R / r) at the distance r.
struct PointStiffness {
  Eigen::Matrix3d force = Eigen::Matrix3d::Zero(), moment = force;  ///< N/m, N m

  /// Of one element. Near the node stresses are those of a wedge: shear along the normal by kappa G
  /// t times its angle, and E t, or E t^3 / 12 about an axis across, along each direction.
  void add(const mesh::FaceAtNode& face, const plate::Material& material, double t)
  {
    constexpr double kappa = 5.0 / 6.0;
    const Eigen::Vector3d n(face.normal[0], face.normal[1], face.normal[2]);
    const double angle = face.edges.empty() ? 2.0 * std::numbers::pi : face.angle;
    const double shear = material.young / (2.0 * (1.0 + material.poisson));
    const Eigen::Matrix3d E = material.young * t * directions(face);
    Eigen::Matrix3d turned;
    for (int j = 0; j < 3; ++j) turned.col(j) = n.cross(E.col(j));
    for (int i = 0; i < 3; ++i) turned.row(i) = n.cross(turned.row(i).transpose()).transpose();
    force += kappa * shear * t * angle * n * n.transpose() + E;
    moment += t * t / 12.0 * turned;
  }
};

/// Of a halving of the distance; nothing where nothing resists, as about the normal.
Eigen::Matrix3d growth(const Eigen::Matrix3d& S)
{
  constexpr double drilling = 1e-9;
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> factor;
  factor.setThreshold(drilling);
  factor.compute(S);
  return std::numbers::ln2 * factor.pseudoInverse();
}

/// Visits the elements of shells at points.
/// @param visit  called with the place of the point among the points, block, element and its node
template <class Visit>
void of_elements_at(const std::vector<int>& points, const mesh::Mesh& mesh, const Visit& visit)
{
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; mesh::is_surface(block.shape) && e < block.n_elements(); ++e) {
      const std::span<const int> nodes = block.element_nodes(e);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto point = std::ranges::lower_bound(points, nodes[i]);
        if (point != points.end() && *point == nodes[i])
          visit(std::size_t(point - points.begin()), block, e, int(i));
      }
    }
  }
}

/// The halvings until nodes beside a point are a tenth of the thickness away; at least 1.
double halvings_left(const scene::Scene& scene, const mesh::Mesh& mesh,
                     const std::vector<int>& points)
{
  constexpr double least = 0.1;
  const std::vector<double> thickness = thicknesses(scene, mesh);
  double halvings = 1.0;
  of_elements_at(points, mesh, [&](std::size_t, const auto& block, int e, int place) {
    const int node = block.element_nodes(e)[std::size_t(place)];
    double nearest = std::numeric_limits<double>::infinity();
    for (const int other : block.element_nodes(e))
      if (other != node) {
        nearest = std::min(nearest, mesh::norm(mesh::minus(mesh.positions[std::size_t(other)],
                                                           mesh.positions[std::size_t(node)])));
      }
    halvings = std::max(halvings, std::log2(nearest / (least * thickness[std::size_t(node)])));
  });
  return halvings;
}

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
  const bool by_orders = is_large && plate::can_rise(model.mesh);
  if (by_orders)
    find_by_orders(model.mesh, on, found);
  else
    find_by_halves(scene, model.mesh, on, found);
  const PointForces forces(scene, model.mesh, PETSC_COMM_WORLD);
  if (forces.points().empty()) return found;
  const MatrixXd elastic = motions.topRows(6 * model.mesh.n_nodes()).rightCols(n - n_rigid);
  forces.add_to(found, forces.lowering(forces.in(elastic, found.omega), found.omega), by_orders);
  return found;
}

PointForces::PointForces(const scene::Scene& scene, const mesh::Mesh& mesh, MPI_Comm comm)
    : scene_(scene), mesh_(mesh), points_(acted_on_at_points(scene, mesh))
{
  if (points_.empty()) return;
  const std::vector<int> section = plate::section_of_group(mesh, scene.sections);
  std::vector<PointStiffness> stiffness(points_.size());
  of_elements_at(points_, mesh, [&](std::size_t i, const auto& block, int e, int place) {
    const auto& of = scene.sections[std::size_t(section[std::size_t(block.group[e])])];
    const double t = plate::value_at(of.thickness, mesh.positions[std::size_t(points_[i])]);
    stiffness[i].add(
        mesh::face_at_node(mesh, block, e, place, mesh::node_derivatives(block.shape, block.order)),
        of.material, t);
  });
  for (const PointStiffness& at : stiffness) {
    of_forces_.push_back(growth(at.force));
    of_moments_.push_back(growth(at.moment));
  }
  shells_ = shells_alone(scene, mesh, comm);
}

MatrixXd PointForces::in(const MatrixXd& motions, const VectorXd& omega) const
{
  const petsc::Matrix X = as_vectors(*shells_, motions);
  const Index k = motions.cols();
  const MatrixXd all = mode_motions(shells_->dofs, linear::sparse_product(shells_->K, X), k) -
                       mode_motions(shells_->dofs, linear::sparse_product(shells_->M, X), k) *
                           omega.cwiseAbs2().asDiagonal();
  MatrixXd forces = MatrixXd::Zero(all.rows(), k);
  for (const int point : points_)
    forces.middleRows<6>(6 * Index(point)) = all.middleRows<6>(6 * Index(point));
  return forces;
}

VectorXd PointForces::lowering(const MatrixXd& forces, const VectorXd& omega) const
{
  VectorXd lowered = VectorXd::Zero(omega.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Index row = 6 * Index(points_[i]);
    for (Index j = 0; j < lowered.size(); ++j) {
      const Eigen::Vector3d f = forces.block<3, 1>(row, j), m = forces.block<3, 1>(row + 3, j);
      lowered[j] += f.dot(of_forces_[i] * f) + m.dot(of_moments_[i] * m);
    }
  }
  return lowered.cwiseQuotient(2.0 * omega.cwiseAbs2());
}

void PointForces::add_to(MeshErrors& found, const VectorXd& per_halving, bool by_orders) const
{
  // Beside such a point what does converge does so with the size, and not with its square.
  constexpr double slower = 0.75 / 0.5;
  const int order = mesh_.blocks.front().order;
  const double step = by_orders ? std::log2(1.0 + 1.0 / order) : 1.0;
  found.per_halving = per_halving;
  found.halvings = halvings_left(scene_, mesh_, points_);
  for (Index i = 0; i < found.errors.size(); ++i) {
    const double lowered = 1.0 - found.finer[i] / found.omega[i];
    const double rest = lowered != 0.0 ? std::abs(1.0 - step * per_halving[i] / lowered) : 1.0;
    found.errors[i] = slower * rest * found.errors[i] + found.halvings * per_halving[i];
  }
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
