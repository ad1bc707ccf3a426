#include "plate/dofs/couplings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Dense>
#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mesh/element_types.hpp"
#include "mesh/nodal_matrices.hpp"
#include "plate/elements/interpolation.hpp"
#include "plate/sections/sections.hpp"

namespace chladni::plate {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d;

namespace {

/// Whether the group goes on in the next sectors, all around the axis.
bool closes_around_axis(const mesh::Mesh& mesh, const mesh::Group& group)
{
  const auto has = [&](int node) {
    return std::ranges::find(group.nodes, node) != group.nodes.end();
  };
  return std::ranges::any_of(mesh.sectors.pairs,
                             [&](const auto& pair) { return has(pair[0]) && has(pair[1]); });
}

std::array<double, 3> centre(const mesh::Mesh& mesh, const mesh::Group& group)
{
  std::array<double, 3> sum{};
  for (const int node : group.nodes)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += mesh.positions[node][c];
  for (double& s : sum) s /= static_cast<double>(group.nodes.size());
  if (closes_around_axis(mesh, group)) return {0.0, 0.0, sum[2]};
  return sum;
}

double squared_distance(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

int nearest_node(const mesh::Mesh& mesh, const mesh::Group& group, int node)
{
  int nearest = -1;
  double least = std::numeric_limits<double>::max();
  for (const int candidate : group.nodes) {
    const double distance = squared_distance(mesh.positions[candidate], mesh.positions[node]);
    if (distance >= least) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

/// What each node follows directly, and through which coupling.
class Following {
 public:
  Following(const mesh::Mesh& mesh, std::span<const Coupling> couplings)
      : mesh_(mesh),
        couplings_(couplings),
        nodes_{.positions = mesh.positions,
               .references = std::vector<int>(mesh.n_nodes(), -1),
               .names_followed = std::vector<std::string>(mesh.n_nodes()),
               .reference_names = {}},
        coupling_(mesh.n_nodes(), -1)
  {}

  /// Of all couplings, before any of them is followed.
  void add_reference_nodes();
  void add(int index);
  CoupledNodes follow_chains() &&;

 private:
  void check(const Coupling& coupling) const;
  void check_held() const;
  bool is_coupling(const std::string& name) const
  {
    return std::ranges::find(couplings_, name, &Coupling::name) != couplings_.end();
  }
  void follow_one_node(int index);
  void add_link(int index);
  void follow(int node, int parent, int index);

  const mesh::Mesh& mesh_;
  std::span<const Coupling> couplings_;
  CoupledNodes nodes_;
  std::vector<int> coupling_;  ///< of each node that follows another one
};

void Following::check(const Coupling& coupling) const
{
  for (const std::string& group : {coupling.group, coupling.to}) {
    if (group.empty() || (group == coupling.to && is_coupling(group))) continue;
    if (mesh::find_group(mesh_, group).nodes.empty())
      throw Error(fmt::format("{}: group \"{}\" has no nodes", describe(coupling), group));
  }
  if (!coupling.has_reference_node()) return;
  const bool used =
      std::ranges::find(mesh_.groups, coupling.name, &mesh::Group::name) != mesh_.groups.end();
  if (used || nodes_.reference_node(coupling.name)) {
    throw Error(
        fmt::format("coupling \"{}\": this name is already used; choose another", coupling.name));
  }
}

void Following::add_reference_nodes()
{
  for (const Coupling& coupling : couplings_) {
    check(coupling);
    if (!coupling.has_reference_node()) continue;
    const mesh::Group& group = mesh::find_group(mesh_, coupling.group);
    nodes_.positions.push_back(coupling.at ? *coupling.at : centre(mesh_, group));
    nodes_.references.push_back(-1);
    nodes_.names_followed.emplace_back();
    nodes_.reference_names.push_back(coupling.name);
  }
}

void Following::follow(int node, int parent, int index)
{
  if (coupling_[node] >= 0) {
    throw Error(fmt::format("node {} depends on two couplings: {} and {}; take it out of one group",
                            mesh_.node_numbers[node], describe(couplings_[coupling_[node]]),
                            describe(couplings_[index])));
  }
  const Coupling& coupling = couplings_[index];
  coupling_[node] = index;
  nodes_.references[node] = parent;
  nodes_.names_followed[node] = coupling.has_reference_node() ? coupling.name : coupling.to;
}

void Following::follow_one_node(int index)
{
  const Coupling& coupling = couplings_[index];
  const std::vector<int> leaders = nodes_.named_nodes(mesh_, coupling.to);
  if (leaders.size() != 1) {
    throw Error(fmt::format("{}: \"{}\" has {} nodes; a rigid body follows one, or a coupling",
                            describe(coupling), coupling.to, leaders.size()));
  }
  for (const int node : mesh::find_group(mesh_, coupling.group).nodes) {
    if (node == leaders.front()) {
      throw Error(fmt::format("{}: node {} belongs to both groups", describe(coupling),
                              mesh_.node_numbers[node]));
    }
    follow(node, leaders.front(), index);
  }
}

void Following::add_link(int index)
{
  const Coupling& link = couplings_[index];
  const mesh::Group& to = mesh::find_group(mesh_, link.to);
  std::vector<int> partner_of(mesh_.n_nodes(), -1);
  for (const int node : mesh::find_group(mesh_, link.group).nodes) {
    const int nearest = nearest_node(mesh_, to, node);
    if (nearest == node) {
      throw Error(fmt::format("{}: node {} belongs to both groups", describe(link),
                              mesh_.node_numbers[node]));
    }
    if (partner_of[nearest] >= 0) {
      throw Error(fmt::format(
          "{}: nodes {} and {} are both nearest to node {}; the nodes of the two groups must pair",
          describe(link), mesh_.node_numbers[partner_of[nearest]], mesh_.node_numbers[node],
          mesh_.node_numbers[nearest]));
    }
    partner_of[nearest] = node;
    follow(node, nearest, index);
  }
}

void Following::add(int index)
{
  const Coupling& coupling = couplings_[index];
  if (coupling.kind == CouplingKind::link) return add_link(index);
  if (!coupling.has_reference_node()) return follow_one_node(index);
  if (coupling.kind == CouplingKind::averaging) return;
  for (const int node : mesh::find_group(mesh_, coupling.group).nodes)
    follow(node, nodes_.reference_node(coupling.name).value(), index);
}

/// Nothing gives stiffness to a reference node that nodes of no element alone follow.
void Following::check_held() const
{
  std::vector<bool> is_held(std::size_t(nodes_.n_nodes()), false);
  mesh::for_connected_nodes(mesh_, [&](std::span<const int> nodes) {
    for (const int node : nodes)
      if (nodes_.is_dependent(node)) is_held[std::size_t(nodes_.reference(node))] = true;
  });
  for (const Coupling& coupling : couplings_) {
    if (coupling.kind != CouplingKind::rigid || !coupling.has_reference_node()) continue;
    if (is_held[std::size_t(nodes_.reference_node(coupling.name).value())]) continue;
    throw Error(fmt::format("{}: no node of \"{}\" belongs to an element", describe(coupling),
                            coupling.group));
  }
}

/// A rigid body on a rigid body is one on the last of the chain.
CoupledNodes Following::follow_chains() &&
{
  const std::vector<int> parent = nodes_.references;
  for (int node = 0; node < mesh_.n_nodes(); ++node) {
    if (parent[node] < 0) continue;
    int end = parent[node];
    int n_links = 1;
    while (parent[end] >= 0 && n_links <= mesh_.n_nodes()) {
      end = parent[end];
      ++n_links;
    }
    if (parent[end] >= 0) {
      throw Error(fmt::format("node {} follows a circle of nodes, {} and {}; take one of them out",
                              mesh_.node_numbers[node], describe(couplings_[coupling_[end]]),
                              describe(couplings_[coupling_[parent[end]]])));
    }
    nodes_.references[node] = end;
  }
  check_held();
  return std::move(nodes_);
}

}  // namespace

std::optional<int> CoupledNodes::reference_node(const std::string& name) const
{
  const auto it = std::ranges::find(reference_names, name);
  if (it == reference_names.end()) return std::nullopt;
  return n_mesh_nodes() + static_cast<int>(it - reference_names.begin());
}

std::vector<int> CoupledNodes::named_nodes(const mesh::Mesh& mesh, const std::string& name) const
{
  if (const auto reference = reference_node(name)) return {*reference};
  const auto group = std::ranges::find(mesh.groups, name, &mesh::Group::name);
  if (group != mesh.groups.end()) return group->nodes;
  std::vector<std::string> names = reference_names;
  for (const mesh::Group& g : mesh.groups) names.push_back(g.name);
  throw Error(
      fmt::format("\"{}\" is neither a group or ring of the mesh nor a coupling; there are: {}",
                  name, fmt::join(names, ", ")));
}

std::string describe(const Coupling& coupling)
{
  return coupling.has_reference_node()
             ? fmt::format("coupling \"{}\"", coupling.name)
             : fmt::format("link of \"{}\" to \"{}\"", coupling.group, coupling.to);
}

CoupledNodes follow_references(const mesh::Mesh& mesh, std::span<const Coupling> couplings)
{
  Following following(mesh, couplings);
  following.add_reference_nodes();
  for (int i = 0; i < std::ssize(couplings); ++i) following.add(i);
  return std::move(following).follow_chains();
}

namespace {

constexpr int nowhere = -1;

/// The rank that numbers each node. A reference node goes to the lowest rank among its dependents,
/// that of an averaging coupling nowhere, since its DOFs stand at its group.
std::vector<int> numbering_ranks(const CoupledNodes& nodes, std::span<const Coupling> couplings,
                                 std::span<const int> owners, int n_ranks)
{
  std::vector<int> ranks(owners.begin(), owners.end());
  ranks.resize(nodes.n_nodes(), n_ranks - 1);
  for (int node = 0; node < nodes.n_mesh_nodes(); ++node) {
    const int reference = nodes.reference(node);
    if (reference < 0) continue;
    ranks[node] = nowhere;
    if (reference < nodes.n_mesh_nodes()) continue;
    ranks[reference] = std::min(ranks[reference], owners[node]);
  }
  for (const Coupling& coupling : couplings) {
    if (coupling.kind != CouplingKind::averaging) continue;
    ranks[nodes.reference_node(coupling.name).value()] = nowhere;
  }
  return ranks;
}

}  // namespace

NumberedNodes number_nodes(CoupledNodes coupled, std::span<const Coupling> couplings,
                           std::span<const int> owners, int n_ranks)
{
  const std::vector<int> ranks = numbering_ranks(coupled, couplings, owners, n_ranks);
  const std::vector<int> none(ranks.size(), -1);
  NumberedNodes nodes{std::move(coupled), none, none, {}};
  int next = 0;
  for (int rank = 0; rank < n_ranks; ++rank) {
    nodes.first_numbers.push_back(next);
    for (std::size_t node = 0; node < ranks.size(); ++node) {
      if (ranks[node] != rank) continue;
      nodes.numbers[node] = next++;
      if (!nodes.rotating.empty() && nodes.rotating[node] != 0)
        nodes.rotation_numbers[node] = next++;
    }
  }
  nodes.first_numbers.push_back(next);
  return nodes;
}

int NumberedNodes::n_independent() const
{
  return static_cast<int>(std::ranges::count_if(numbers, [](int number) { return number >= 0; }));
}

int NumberedNodes::coordinate(int node, int component) const
{
  if (component < 3 || rotating.empty()) return 6 * number(node) + component;
  return rotation_numbers[node] < 0 ? -1 : 6 * rotation_numbers[node] + component - 3;
}

std::vector<MotionTerm> NumberedNodes::own_motion(int node) const
{
  if (rotation_numbers[node] < 0) return {{.number = number(node), .T = Matrix6d::Identity()}};
  MotionTerm u{.number = number(node), .T = Matrix6d::Zero()};
  MotionTerm theta{.number = rotation_numbers[node], .T = Matrix6d::Zero()};
  u.T.topLeftCorner<3, 3>().setIdentity();
  theta.T.bottomLeftCorner<3, 3>().setIdentity();
  return {u, theta};
}

namespace {

constexpr double no_rotation = 1e-9;  // of the largest pivot

/// The blocks of a row of six equations, by active number.
using Blocks = std::map<int, Matrix6d>;

/// The weights of the nodes of a group in its mean.
struct Weights {
  std::map<int, double> shares;
  /// int N_i x dA of faces of solids, m^3, which replace the shares times the positions of the
  /// nodes: a moment then acts as a linear traction, not more at the nodes with large shares. Else
  /// empty.
  std::map<int, Vector3d> moments;
};

/// Those of a group of the mesh.
Weights mean_weights(const mesh::Mesh& mesh, const std::string& group);

/// The motion of the reference node as the mean of its group: A q.
Blocks mean_motion(const NodeMotions& motions, const Weights& weights, int reference)
{
  const std::map<int, double>& shares = weights.shares;
  const std::map<int, Vector3d>& moments = weights.moments;
  double sum = 0.0;
  Vector3d centre = Vector3d::Zero();
  for (const auto& [node, share] : shares) {
    sum += share;
    centre += share * motions.position(node);
  }
  centre /= sum;
  const auto weighted_arm = [&](int node, double w) -> Matrix3d {
    if (moments.empty()) return w * cross_matrix(motions.position(node) - centre);
    return cross_matrix(moments.at(node) / sum - w * centre);
  };
  Matrix3d J = Matrix3d::Zero();
  for (const auto& [node, share] : shares)
    J -= weighted_arm(node, share / sum) * cross_matrix(motions.position(node) - centre);
  const Matrix3d J_inverse = J.completeOrthogonalDecomposition().pseudoInverse();
  const Matrix6d to_reference = rigid_arm(motions.position(reference) - centre);
  Blocks A;
  for (const auto& [node, share] : shares) {
    const double w = share / sum;
    Matrix6d of_node = Matrix6d::Zero();
    of_node.topLeftCorner<3, 3>() = w * Matrix3d::Identity();
    of_node.bottomLeftCorner<3, 3>() =
        moments.empty() ? Matrix3d(w * J_inverse * cross_matrix(motions.position(node) - centre))
                        : Matrix3d(J_inverse * weighted_arm(node, w));
    for (const MotionTerm& term : motions.motion(node))
      A.try_emplace(term.number, Matrix6d::Zero()).first->second += to_reference * of_node * term.T;
  }
  return A;
}

/// The six columns of A that are solved for: coordinates 6 * number + place, ascending by pivoting,
/// and their block inverted.
struct Pivots {
  std::array<int, 6> dof;
  Matrix6d inverse;
};

/// Rows of rotation are scaled by the size of the group, so that all are lengths.
/// @param node_of  [n_active] the node whose displacements a number has; -1 for one of rotations
Pivots choose_pivots(const Blocks& A, const std::vector<int>& node_of, double length,
                     const Coupling& coupling)
{
  MatrixXd columns = MatrixXd::Zero(6, 3 * static_cast<Index>(A.size()));
  std::vector<int> dof;
  for (const auto& [number, block] : A) {
    for (int c = 0; c < 3 && node_of[number] >= 0; ++c) {  // displacements only
      columns.col(std::ssize(dof)) = block.col(c);
      dof.push_back(6 * number + c);
    }
  }
  columns.conservativeResize(Eigen::NoChange, std::ssize(dof));
  columns.bottomRows<3>() *= length;
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
  const Eigen::VectorXd pivots = qr.matrixR().diagonal().cwiseAbs();
  if (pivots.size() < 6 || pivots[5] < no_rotation * pivots[0]) {
    throw Error(fmt::format(
        "{}: the nodes of \"{}\" lie on one line or are too few; their mean has no rotation about "
        "every axis",
        describe(coupling), coupling.group));
  }
  Pivots chosen;
  Matrix6d P;
  for (int k = 0; k < 6; ++k) {
    const Index column = qr.colsPermutation().indices()[k];
    chosen.dof[k] = dof[column];
    P.col(k) = columns.col(column);
  }
  P.bottomRows<3>() /= length;
  chosen.inverse = P.inverse();
  return chosen;
}

/// The motion of the reference node: its components stand at the pivots.
CombinedMotion reference_motion(const Pivots& pivots)
{
  Blocks T;
  for (int k = 0; k < 6; ++k) {
    const auto [number, component] = std::pair(pivots.dof[k] / 6, pivots.dof[k] % 6);
    T.try_emplace(number, Matrix6d::Zero()).first->second(k, component) = 1.0;
  }
  CombinedMotion motion{.followed = {}, .terms = {}, .coordinates = pivots.dof};
  for (const auto& [number, block] : T) motion.terms.push_back({number, block});
  return motion;
}

/// The motion of a node that holds pivots: those displacements are P^-1 (u_ref - A_rest q_rest).
CombinedMotion pivot_node_motion(const NumberedNodes& nodes, int node, const Blocks& A,
                                 const Pivots& pivots)
{
  const int number = nodes.number(node);
  CombinedMotion motion{.followed = {}, .terms = {}, .coordinates = {}};
  for (int c = 0; c < 6; ++c) motion.coordinates[c] = nodes.coordinate(node, c);
  Blocks T;
  for (const MotionTerm& own : nodes.own_motion(node)) T[own.number] = own.T;
  for (int k = 0; k < 6; ++k) {
    if (pivots.dof[k] / 6 != number) continue;
    const int component = pivots.dof[k] % 6;
    motion.coordinates[component] = -1;
    for (const auto& [other, block] : A) {
      Eigen::Matrix<double, 1, 6> row = -pivots.inverse.row(k) * block;
      for (int l = 0; l < 6; ++l)  // where pivots stood there is now the reference node
        if (pivots.dof[l] / 6 == other) row[pivots.dof[l] % 6] = pivots.inverse(k, l);
      T.try_emplace(other, Matrix6d::Zero()).first->second.row(component) = row;
    }
  }
  for (const auto& [other, block] : T) motion.terms.push_back({other, block});
  return motion;
}

double size_of(const NodeMotions& motions, const std::vector<int>& nodes, int reference)
{
  double size = 0.0;
  for (const int node : nodes)
    size = std::max(size, (motions.position(node) - motions.position(reference)).norm());
  return size > 0.0 ? size : 1.0;
}

/// The mean of a group must not move its own nodes, nor those of another one.
void refuse_followers(const NodeMotions& motions, const mesh::Mesh& mesh, const Coupling& coupling)
{
  for (const int node : mesh::find_group(mesh, coupling.group).nodes) {
    const int followed = motions.reference(node);
    if (followed < motions.n_mesh_nodes() || motions.number(followed) >= 0) continue;
    throw Error(fmt::format(
        "{}: node {} of its group follows the mean \"{}\"; take it out of one of both groups",
        describe(coupling), mesh.node_numbers[node], motions.reference_name(followed)));
  }
}

/// Numbers of one group must not be in another average.
void claim(const Blocks& A, std::map<int, int>& claimed, int index,
           std::span<const Coupling> couplings)
{
  for (const auto& [number, block] : A) {
    const auto [it, is_new] = claimed.emplace(number, index);
    if (is_new || it->second == index) continue;
    throw Error(fmt::format("{} and {} average nodes in common; take them out of one group",
                            describe(couplings[it->second]), describe(couplings[index])));
  }
}

}  // namespace

Matrix3d cross_matrix(const Vector3d& a)
{
  Matrix3d A;
  A << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return A;
}

Matrix6d rigid_arm(const Vector3d& arm)
{
  Matrix6d T = Matrix6d::Identity();
  T.topRightCorner<3, 3>() = cross_matrix(arm).transpose();  // theta x arm
  return T;
}

std::vector<MotionTerm> NodeMotions::motion(int node) const
{
  const int end = is_dependent(node) ? reference(node) : node;
  const auto it = combined.find(end);
  std::vector<MotionTerm> terms;
  if (it != combined.end())
    terms = it->second.terms;
  else
    terms = own_motion(end);
  if (end == node) return terms;
  const Matrix6d T = rigid_arm(arm(node));
  for (MotionTerm& term : terms) term.T = T * term.T;
  return terms;
}

bool NodeMotions::has_combined_motions() const
{
  return std::ranges::any_of(combined, [](const auto& of) { return !of.second.by_faces; });
}

const std::string& NodeMotions::followed(int node) const
{
  const auto it = combined.find(node);
  return it == combined.end() ? names_followed[node] : it->second.followed;
}

void rewrite_by_faces(NodeMotions& motions, const std::map<int, std::vector<MotionTerm>>& became)
{
  for (auto& [node, motion] : motions.combined) {
    if (!motion.by_faces) continue;
    Blocks T;
    const auto add = [&](int number, const Matrix6d& block) {
      T.try_emplace(number, Matrix6d::Zero()).first->second += block;
    };
    for (const MotionTerm& term : motion.terms) {
      const auto found = became.find(term.number);
      if (found == became.end())
        add(term.number, term.T);
      else
        for (const MotionTerm& other : found->second) add(other.number, term.T * other.T);
    }
    motion.terms.clear();
    for (const auto& [number, block] : T) motion.terms.push_back({number, block});
  }
}

namespace {

/// The ring that a node is of.
const std::string& ring_of(const mesh::Mesh& mesh, int node)
{
  const auto has = [&](const mesh::Group& group) {
    return std::ranges::find(group.nodes, node) != group.nodes.end();
  };
  return std::ranges::find_if(mesh.groups, has)->name;
}

/// The equations u = A u_j of the nodes on faces, and the places of those that they are solved for.
struct FaceEquations {
  std::vector<int> nodes;     ///< of the faces, ascending
  MatrixXd A;                 ///< [n on faces x n nodes]
  std::vector<Index> pivots;  ///< [n on faces] columns
  MatrixXd P_inverse;         ///< of these columns of A

  FaceEquations(const mesh::Mesh& mesh, const NodeMotions& motions);
  int pivot(Index i) const { return nodes[std::size_t(pivots[std::size_t(i)])]; }

 private:
  void choose_pivots(const mesh::Mesh& mesh, const NodeMotions& motions);
};

FaceEquations::FaceEquations(const mesh::Mesh& mesh, const NodeMotions& motions)
{
  for (const mesh::FaceNode& on_face : mesh.face_nodes)
    nodes.insert(nodes.end(), on_face.nodes.begin(), on_face.nodes.end());
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  A = MatrixXd::Zero(std::ssize(mesh.face_nodes), std::ssize(nodes));
  for (Index k = 0; k < A.rows(); ++k) {
    const mesh::FaceNode& on_face = mesh.face_nodes[std::size_t(k)];
    for (std::size_t j = 0; j < on_face.nodes.size(); ++j)
      A(k, std::ranges::lower_bound(nodes, on_face.nodes[j]) - nodes.begin()) = on_face.weights[j];
  }
  choose_pivots(mesh, motions);
  constexpr double none = 1e-14;  // what nodes far along a ring have of each other
  const MatrixXd inverse = A(every, pivots).inverse();
  P_inverse = (inverse.array().abs() < none * inverse.cwiseAbs().maxCoeff()).select(0.0, inverse);
}

void FaceEquations::choose_pivots(const mesh::Mesh& mesh, const NodeMotions& motions)
{
  // Rows of one size: means over patches have small weights.
  MatrixXd weights = A.array().colwise() / A.cwiseAbs().rowwise().maxCoeff().array();
  for (Index j = 0; j < A.cols(); ++j)
    if (!motions.is_plain(nodes[std::size_t(j)])) weights.col(j).setZero();
  constexpr double not_small = 0.25, distinct = 1e-4;
  pivots.assign(std::size_t(A.rows()), -1);
  std::vector<Index> rest;
  const Eigen::VectorXi n_users = (weights.array() != 0.0).cast<int>().colwise().sum().matrix();
  for (Index k = 0; k < A.rows(); ++k) {
    const Eigen::RowVectorXd own =
        (n_users.transpose().array() == 1).select(weights.row(k).cwiseAbs(), 0.0);
    if (own.maxCoeff(&pivots[std::size_t(k)]) < not_small) rest.push_back(k);
  }
  if (rest.empty()) return;
  for (Index k = 0; k < A.rows(); ++k)
    if (std::ranges::find(rest, k) == rest.end()) weights.col(pivots[std::size_t(k)]).setZero();
  const MatrixXd left = weights(rest, every);
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(left);
  const Eigen::VectorXd diagonal = qr.matrixR().diagonal().cwiseAbs();
  if (diagonal.size() < std::ssize(rest) || diagonal.minCoeff() < distinct * diagonal.maxCoeff()) {
    const int node = mesh.face_nodes[std::size_t(rest.back())].node;
    throw Error(fmt::format(
        "ring \"{}\": its nodes on faces are closer than the nodes of the mesh can tell apart, or "
        "the faces follow a coupling; take fewer nodes on the ring, or smaller elements there",
        ring_of(mesh, node)));
  }
  for (std::size_t i = 0; i < rest.size(); ++i)
    pivots[std::size_t(rest[i])] = qr.colsPermutation().indices()[Index(i)];
}

/// The motion of the node that equation i is solved for, by what stands in its place and the
/// others.
CombinedMotion pivot_on_face(const FaceEquations& equations, const NodeMotions& motions, Index i,
                             const std::string& ring)
{
  constexpr std::size_t most = 1000;  // numbers: element matrices have as many columns, times 6
  const auto& [nodes, A, pivots, P_inverse] = equations;
  Eigen::RowVectorXd by_node = -P_inverse.row(i) * A;
  for (std::size_t k = 0; k < pivots.size(); ++k)  // where pivots stood there are nodes on faces
    by_node[pivots[k]] = P_inverse(i, Index(k));
  Blocks T;
  for (Index j = 0; j < by_node.size(); ++j) {
    if (by_node[j] == 0.0) continue;
    for (const MotionTerm& term : motions.motion(nodes[std::size_t(j)]))
      T.try_emplace(term.number, Matrix6d::Zero()).first->second += by_node[j] * term.T;
  }
  if (T.size() > most) {
    throw Error(fmt::format(
        "ring \"{}\": its nodes on faces are so close that one of them depends on {} nodes of the "
        "mesh, {} at most; take fewer nodes on the ring",
        ring, T.size(), most));
  }
  CombinedMotion motion{.followed = ring, .terms = {}, .coordinates = {}, .by_faces = true};
  motion.coordinates.fill(-1);
  for (const auto& [number, block] : T) motion.terms.push_back({number, block});
  return motion;
}

}  // namespace

NodeMotions face_motions(const mesh::Mesh& mesh, NumberedNodes numbered)
{
  NodeMotions motions{std::move(numbered), {}};
  if (mesh.face_nodes.empty()) return motions;
  const FaceEquations equations(mesh, motions);
  std::map<int, CombinedMotion> combined;
  for (Index i = 0; i < equations.A.rows(); ++i) {
    const int ring_node = mesh.face_nodes[std::size_t(i)].node;
    combined.emplace(equations.pivot(i),
                     pivot_on_face(equations, motions, i, ring_of(mesh, ring_node)));
  }
  for (Index k = 0; k < equations.A.rows(); ++k) {
    motions.numbers[std::size_t(mesh.face_nodes[std::size_t(k)].node)] =
        std::exchange(motions.numbers[std::size_t(equations.pivot(k))], -1);
  }
  motions.combined = std::move(combined);
  return motions;
}

NodeMotions average_motions(const mesh::Mesh& mesh, std::span<const Coupling> couplings,
                            NodeMotions motions)
{
  std::map<int, int> claimed;
  std::vector<int> node_of(motions.n_active(), -1);
  for (int node = 0; node < motions.n_nodes(); ++node)
    if (motions.number(node) >= 0) node_of[motions.number(node)] = node;
  for (const mesh::FaceNode& on_face : mesh.face_nodes)  // whose DOFs stay those of rings
    node_of[motions.number(on_face.node)] = -1;
  for (int i = 0; i < std::ssize(couplings); ++i) {
    if (couplings[i].kind != CouplingKind::averaging) continue;
    const std::vector<int>& group = mesh::find_group(mesh, couplings[i].group).nodes;
    const int reference = motions.reference_node(couplings[i].name).value();
    refuse_followers(motions, mesh, couplings[i]);
    const Blocks A = mean_motion(motions, mean_weights(mesh, couplings[i].group), reference);
    claim(A, claimed, i, couplings);
    const Pivots pivots =
        choose_pivots(A, node_of, size_of(motions, group, reference), couplings[i]);
    motions.combined.emplace(reference, reference_motion(pivots));
    std::map<int, std::vector<MotionTerm>> became;
    for (const int dof : pivots.dof) {
      const int node = node_of[dof / 6];
      if (motions.combined.contains(node)) continue;
      CombinedMotion motion = pivot_node_motion(motions, node, A, pivots);
      motion.followed = couplings[i].name;
      became.emplace(motions.number(node), motion.terms);
      motions.combined.emplace(node, std::move(motion));
    }
    rewrite_by_faces(motions, became);
  }
  return motions;
}

namespace {

/// Factors of coordinates, as 6 * number + place.
using Factors = std::map<int, double>;

void add_times(Factors& sum, double factor, const Factors& other)
{
  for (const auto& [coordinate, value] : other) sum[coordinate] += factor * value;
}

/// Gauss and Jordan: coordinates as combinations of those that no equation is solved for.
class SolvedEquations {
 public:
  void add(Factors equation, int first)
  {
    constexpr double cancelled = 1e-10, small = 1e-2;  // of the largest factor
    double scale = 0.0;
    for (const auto& [coordinate, value] : equation) scale = std::max(scale, std::abs(value));
    equation = substituted(equation);
    std::erase_if(equation, [&](const auto& f) { return std::abs(f.second) <= cancelled * scale; });
    if (equation.empty()) return;
    auto pivot = std::ranges::max_element(
        equation, {}, [](const auto& factor) { return std::abs(factor.second); });
    const auto wanted = equation.find(first);
    if (wanted != equation.end() && std::abs(wanted->second) >= small * std::abs(pivot->second))
      pivot = wanted;
    const auto [coordinate, value] = *pivot;
    equation.erase(pivot);
    for (auto& [other, factor] : equation) factor /= -value;
    for (const int user : std::exchange(users_[coordinate], {})) {
      Factors& by = solved_.at(user);
      const double factor = by.at(coordinate);
      by.erase(coordinate);
      add_times(by, factor, equation);
      for (const auto& [other, of_other] : equation) users_[other].insert(user);
    }
    for (const auto& [other, factor] : equation) users_[other].insert(coordinate);
    solved_.emplace(coordinate, std::move(equation));
  }

  Factors substituted(const Factors& factors) const
  {
    Factors sum;
    for (const auto& [coordinate, value] : factors) {
      const auto found = solved_.find(coordinate);
      if (found == solved_.end())
        sum[coordinate] += value;
      else
        add_times(sum, value, found->second);
    }
    return sum;
  }

  const std::map<int, Factors>& solved() const { return solved_; }

 private:
  std::map<int, Factors> solved_;
  std::map<int, std::set<int>> users_;  ///< of each coordinate: those that are made of it
};

/// A component of the motion of a node by coordinates.
Factors component_of(const std::vector<MotionTerm>& motion, int component)
{
  Factors factors;
  for (const MotionTerm& term : motion)
    for (int c = 0; c < 6; ++c)
      if (const double value = term.T(component, c); value != 0.0)
        factors[6 * term.number + c] += value;
  return factors;
}

/// The motion of a node without the coordinates that equations are solved for.
std::vector<MotionTerm> without_solved(const std::vector<MotionTerm>& motion,
                                       const SolvedEquations& equations)
{
  Blocks T;
  for (int component = 0; component < 6; ++component)
    for (const auto& [coordinate, value] : equations.substituted(component_of(motion, component))) {
      T.try_emplace(coordinate / 6, Matrix6d::Zero()).first->second(component, coordinate % 6) =
          value;
    }
  std::vector<MotionTerm> terms;
  for (const MotionTerm& own : motion) {  // these first, by which pieces of the mesh are known
    const auto found = T.find(own.number);
    terms.push_back({own.number, found == T.end() ? Matrix6d::Zero() : found->second});
    if (found != T.end()) T.erase(found);
  }
  for (const auto& [number, block] : T) terms.push_back({number, block});
  return terms;
}

/// Components that nodes of equations alone have in none of these are zero.
SolvedEquations solved_equations(const mesh::Mesh& mesh, const NodeMotions& motions)
{
  SolvedEquations all;
  for (const mesh::Equation& equation : mesh.equations) {
    Factors sum;
    for (const auto& [node, component, factor] : equation.terms) {
      if (component >= 3 && !motions.has_rotations(node)) {
        throw Error(fmt::format("{}: node {} of a solid has no rotations", equation.place,
                                mesh.node_numbers[node]));
      }
      add_times(sum, factor, component_of(motions.motion(node), component));
    }
    const auto& [node, component, factor] = equation.terms.front();
    const Factors first = component_of(motions.motion(node), component);
    all.add(sum, first.size() == 1 ? first.begin()->first : -1);
  }
  for (const auto& [node, components] : nodes_of_equations_alone(mesh, motions))
    for (int c = 0; c < 6; ++c)
      if (const int at = motions.coordinate(node, c); at >= 0 && !components.contains(c))
        all.add({{at, 1.0}}, at);
  return all;
}

}  // namespace

std::map<int, std::set<int>> nodes_of_equations_alone(const mesh::Mesh& mesh,
                                                      const CoupledNodes& nodes)
{
  std::map<int, std::set<int>> components;
  for (const mesh::Equation& equation : mesh.equations)
    for (const auto& [node, component, factor] : equation.terms) components[node].insert(component);
  mesh::for_connected_nodes(mesh, [&](std::span<const int> of_element) {
    for (const int node : of_element) components.erase(node);
  });
  std::erase_if(components, [&](const auto& of) { return nodes.is_dependent(of.first); });
  for (const int reference : nodes.references) components.erase(reference);
  return components;
}

NodeMotions equation_motions(const mesh::Mesh& mesh, NodeMotions motions)
{
  if (mesh.equations.empty()) return motions;
  const SolvedEquations equations = solved_equations(mesh, motions);
  std::set<int> numbers;
  for (const auto& [coordinate, by] : equations.solved()) {
    motions.unused.push_back(coordinate);
    numbers.insert(coordinate / 6);
  }
  std::ranges::sort(motions.unused);
  const auto is_solved = [&](int at) { return at >= 0 && equations.solved().contains(at); };
  for (int node = 0; node < motions.n_nodes(); ++node) {
    if (motions.is_dependent(node)) continue;
    const std::vector<MotionTerm> before = motions.motion(node);
    if (std::ranges::none_of(before, [&](const auto& of) { return numbers.contains(of.number); }))
      continue;
    CombinedMotion motion{.followed = {}, .terms = {}, .coordinates = {}};
    if (const auto found = motions.combined.find(node); found != motions.combined.end())
      motion = found->second;
    else
      for (int c = 0; c < 6; ++c) motion.coordinates[c] = motions.coordinate(node, c);
    for (int& at : motion.coordinates)
      if (is_solved(at)) at = -1;
    motion.terms = without_solved(before, equations);
    motion.n_own = static_cast<int>(before.size());
    motions.combined[node] = std::move(motion);
  }
  return motions;
}

namespace {

/// int N_i ds along one edge.
Eigen::VectorXd shares_of_edge(const mesh::Mesh& mesh, const std::vector<int>& edge)
{
  const auto p = static_cast<int>(edge.size()) - 1;
  const GaussRule gauss = gauss_legendre(p + 2);
  const Eigen::VectorXd ends = Eigen::VectorXd::LinSpaced(2, -1.0, 1.0);
  const Points points =
      tensor_points(gauss.x, ends.head(1));  // the lower edge of the parent square
  const Basis basis = lagrange_basis(mesh::Shape::quadrilateral, p, points);
  Eigen::MatrixX3d x(p + 1, 3);
  for (int i = 0; i <= p; ++i) x.row(i) = Eigen::RowVector3d(mesh.positions[edge[i]].data());
  const Eigen::MatrixX3d tangents = basis.N_xi.leftCols(p + 1) * x;
  const Eigen::VectorXd lengths = gauss.w.cwiseProduct(tangents.rowwise().norm());
  return basis.N.leftCols(p + 1).transpose() * lengths;
}

/// dA of the points of one surface.
Eigen::VectorXd areas_of_points(const NodeVectors& x, const Points& points, const Basis& basis)
{
  const NodeVectors a_1 = basis.N_xi * x;
  const NodeVectors a_2 = basis.N_eta * x;
  Eigen::VectorXd areas(points.size());
  for (Eigen::Index q = 0; q < points.size(); ++q)
    areas[q] = points.weight[q] * a_1.row(q).cross(a_2.row(q)).norm();
  return areas;
}

Eigen::VectorXd shares_of_element(const mesh::Mesh& mesh, const mesh::ElementBlock& block,
                                  int element)
{
  const Points points = gauss_points(block.shape, block.order + 2);
  const Basis basis = lagrange_basis(block.shape, block.order, points);
  return basis.N.transpose() *
         areas_of_points(element_positions(mesh, block, element), points, basis);
}

/// int N_i dA, and int N_i x dA, of one face.
/// @return [n x 4]
Eigen::MatrixX4d integrals_of_face(const mesh::Mesh& mesh, const mesh::FreeFace& face)
{
  NodeVectors x(std::ssize(face.nodes), 3);
  for (Index i = 0; i < x.rows(); ++i)
    x.row(i) = Eigen::RowVector3d(mesh.positions[face.nodes[std::size_t(i)]].data());
  const FaceRule& rule =
      face_rule(static_cast<int>(face.nodes.size()), mesh.blocks[face.block].order);
  Eigen::MatrixX4d at_points(rule.points.size(), 4);
  at_points << Eigen::VectorXd::Ones(rule.points.size()), rule.basis.N * x;
  return rule.basis.N.transpose() *
         (areas_of_points(x, rule.points, rule.basis).asDiagonal() * at_points);
}

/// Calls visit(face) for the free faces of solids that have all their nodes in a group.
template <typename Visit>
void for_faces_in(const mesh::Mesh& mesh, const mesh::Group& group, const Visit& visit)
{
  const std::set<int> members(group.nodes.begin(), group.nodes.end());
  for (const mesh::FreeFace& face : mesh::free_faces(mesh))
    if (std::ranges::all_of(face.nodes, [&](int node) { return members.contains(node); }))
      visit(face);
}

std::map<int, double> surface_shares(const mesh::Mesh& mesh, const mesh::Group& group)
{
  const auto index = static_cast<int>(&group - mesh.groups.data());
  std::map<int, double> shares;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (!mesh::is_surface(block.shape)) continue;
    for (int e = 0; e < block.n_elements(); ++e) {
      if (block.group[e] != index) continue;
      const Eigen::VectorXd of_element = shares_of_element(mesh, block, e);
      for (Eigen::Index i = 0; i < of_element.size(); ++i)
        shares[block.element_nodes(e)[i]] += of_element[i];
    }
  }
  for_faces_in(mesh, group, [&](const mesh::FreeFace& face) {
    const Eigen::MatrixX4d of_face = integrals_of_face(mesh, face);
    for (std::size_t i = 0; i < face.nodes.size(); ++i)
      shares[face.nodes[i]] += of_face(static_cast<Index>(i), 0);
  });
  return shares;
}

}  // namespace

std::map<int, double> edge_shares(const mesh::Mesh& mesh, const std::string& group)
{
  std::map<int, double> shares;
  for (const std::vector<int>& edge : mesh::edges_in(mesh, mesh::find_group(mesh, group))) {
    const Eigen::VectorXd of_edge = shares_of_edge(mesh, edge);
    for (std::size_t i = 0; i < edge.size(); ++i)
      shares[edge[i]] += of_edge[static_cast<Eigen::Index>(i)];
  }
  return shares;
}

std::map<int, double> group_shares(const mesh::Mesh& mesh, const std::string& name)
{
  const mesh::Group& group = mesh::find_group(mesh, name);
  std::map<int, double> shares =
      group.dimension == 2 ? surface_shares(mesh, group) : edge_shares(mesh, name);
  const auto has_share = [&](int node) { return shares.contains(node); };
  if (std::ranges::all_of(group.nodes, has_share)) return shares;
  shares.clear();  // nodes without the edges between them
  for (const int node : group.nodes) shares[node] = 1.0;
  return shares;
}

namespace {

Weights mean_weights(const mesh::Mesh& mesh, const std::string& name)
{
  Weights weights{.shares = group_shares(mesh, name), .moments = {}};
  const mesh::Group& group = mesh::find_group(mesh, name);
  if (group.dimension != 2) return weights;
  for_faces_in(mesh, group, [&](const mesh::FreeFace& face) {
    const Eigen::MatrixX4d of_face = integrals_of_face(mesh, face);
    for (std::size_t i = 0; i < face.nodes.size(); ++i) {
      weights.moments.try_emplace(face.nodes[i], Vector3d::Zero()).first->second +=
          of_face.row(static_cast<Index>(i)).tail<3>().transpose();
    }
  });
  const auto has_moment = [&](const auto& share) { return weights.moments.contains(share.first); };
  if (!std::ranges::all_of(weights.shares, has_moment)) weights.moments.clear();
  return weights;
}

}  // namespace

}  // namespace chladni::plate
