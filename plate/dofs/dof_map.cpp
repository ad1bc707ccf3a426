#include "plate/dofs/dof_map.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "common/error.hpp"
#include "mesh/nodal_matrices.hpp"

namespace chladni::plate {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

namespace {

/// The DOFs of averages and harmonics stand in those of a group, whatever component these are.
void check_components(const mesh::Mesh& mesh, const Kinematics& kinematics)
{
  if (kinematics.components.size() == 6) return;
  if (!mesh.equations.empty())
    throw Error(fmt::format("{} needs all six DOFs of each node", mesh.equations.front().place));
  if (!kinematics.rings.empty()) {
    throw Error(fmt::format("ring \"{}\": harmonics need all six DOFs of each node",
                            kinematics.rings.front().ring));
  }
  if (std::ranges::count(kinematics.couplings, CouplingKind::averaging, &Coupling::kind) == 0)
    return;
  throw Error(
      "an averaging coupling needs all six DOFs of each node; use a rigid one, or all six DOFs");
}

/// Which nodes belong to elements of solids, and which to shells or beams. Of a mesh with matrices
/// these are the nodes with three DOFs, and those with six.
struct NodesOfElements {
  std::vector<char> solid, other;

  explicit NodesOfElements(const mesh::Mesh& mesh)
      : solid(std::size_t(mesh.n_nodes()), 0), other(std::size_t(mesh.n_nodes()), 0)
  {
    if (mesh.matrices) {
      const auto& n_components = mesh.matrices->n_components;  // rings on faces have nodes beyond
      for (std::size_t node = 0; node < n_components.size(); ++node) {
        const auto n = n_components[node];
        if (n > 0) (n == 3 ? solid : other)[node] = 1;
      }
      return;
    }
    for (const mesh::ElementBlock& block : mesh.blocks)
      for (const int node : block.nodes)
        (mesh::is_solid(block.shape) ? solid : other)[std::size_t(node)] = 1;
  }
};

constexpr const char* couple_rigidly =
    "couple it to a group of nodes of the solid ([[coupling]], type \"rigid\")";

/// A shell or beam would turn freely about a node that it shares with a solid.
void refuse_hinges(const mesh::Mesh& mesh, const NodesOfElements& of)
{
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    if (of.solid[std::size_t(node)] == 0 || of.other[std::size_t(node)] == 0) continue;
    throw Error(fmt::format(
        "node {} belongs to a solid, which has no rotations there, and to a shell or beam, which "
        "would hang at it as at a hinge; give the shell or beam a node of its own and {}",
        mesh.node_numbers[node], couple_rigidly));
  }
}

/// The same of a link to a node without rotations, which does not turn what is linked to it either.
void refuse_hinges(const mesh::Mesh& mesh, const CoupledNodes& nodes, const NodesOfElements& of,
                   const Coupling& link)
{
  constexpr double at_one_place = 1e-8;  // of the size of the model: its coordinates have 12 digits
  double size = 0.0;
  for (int node = 0; node < mesh.n_nodes(); ++node)
    size = std::max(size, (nodes.position(node) - nodes.position(0)).norm());
  for (const int node : mesh::find_group(mesh, link.group).nodes) {
    if (nodes.has_rotations(node)) continue;
    const std::int64_t number = mesh.node_numbers[node],
                       end = mesh.node_numbers[nodes.reference(node)];
    if (of.other[std::size_t(node)] != 0) {
      throw Error(fmt::format(
          "{}: node {} of a shell or beam follows node {}, which has no rotations, and would hang "
          "at it as at a hinge; {}",
          describe(link), number, end, couple_rigidly));
    }
    if (nodes.arm(node).norm() <= at_one_place * size) continue;
    throw Error(
        fmt::format("{}: node {} is {:.3g} m away from node {}, which has no rotations and would "
                    "not turn it; link nodes at one place, or {}",
                    describe(link), number, nodes.arm(node).norm(), end, couple_rigidly));
  }
}

/// Whether nodes resist a rotation about every axis by their displacements.
bool span_a_plane(const CoupledNodes& nodes, const std::vector<int>& members)
{
  constexpr double flat = 1e-12;  // of squared lengths
  Vector3d mean = Vector3d::Zero();
  for (const int node : members) mean += nodes.position(node) / double(members.size());
  Matrix3d second = Matrix3d::Zero();
  for (const int node : members)
    second += (nodes.position(node) - mean) * (nodes.position(node) - mean).transpose();
  const Vector3d squares = Eigen::SelfAdjointEigenSolver<Matrix3d>(second).eigenvalues();
  return squares[1] > flat * squares[2];
}

/// The node whose rotations move what a coupling couples.
int end_of(const mesh::Mesh& mesh, const CoupledNodes& nodes, const Coupling& coupling)
{
  const int leader = coupling.has_reference_node() ? nodes.reference_node(coupling.name).value()
                                                   : nodes.named_nodes(mesh, coupling.to).front();
  return nodes.is_dependent(leader) ? nodes.reference(leader) : leader;
}

/// Solids whose nodes in a rigid coupling lie on one line let it turn about this line.
void refuse_lines(const mesh::Mesh& mesh, std::span<const Coupling> couplings,
                  const CoupledNodes& nodes, const NodesOfElements& of)
{
  std::map<int, std::vector<int>> members;  // nodes of solids by the end that they follow
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (of.solid[std::size_t(node)] != 0)
      members[nodes.is_dependent(node) ? nodes.reference(node) : node].push_back(node);
  for (const Coupling& coupling : couplings) {
    if (coupling.kind != CouplingKind::rigid) continue;
    const auto found = members.find(end_of(mesh, nodes, coupling));
    if (found == members.end() || span_a_plane(nodes, found->second)) continue;
    throw Error(fmt::format(
        "{}: its nodes of solids lie on one line or are fewer than three, and nodes of solids have "
        "no rotations, so that nothing resists a rotation about this line; couple more nodes",
        describe(coupling)));
  }
}

/// The nodes with rotations in a model with solids: those of shells and beams, reference nodes, and
/// nodes that others follow as a rigid body, also by equations.
/// @return [n_nodes]; empty for a mesh without solids
std::vector<char> rotating_nodes(const mesh::Mesh& mesh, std::span<const Coupling> couplings,
                                 const CoupledNodes& nodes)
{
  const NodesOfElements of(mesh);
  if (std::ranges::count(of.solid, 1) == 0) return {};
  refuse_hinges(mesh, of);
  CoupledNodes with = nodes;
  with.rotating = of.other;
  with.rotating.resize(std::size_t(nodes.n_nodes()), 1);
  for (const Coupling& coupling : couplings)
    if (coupling.kind == CouplingKind::rigid) with.rotating[end_of(mesh, nodes, coupling)] = 1;
  for (const auto& [node, components] : nodes_of_equations_alone(mesh, nodes))
    if (*components.rbegin() >= 3) with.rotating[std::size_t(node)] = 1;
  refuse_lines(mesh, couplings, nodes, of);
  for (const Coupling& coupling : couplings)
    if (coupling.kind == CouplingKind::link) refuse_hinges(mesh, with, of, coupling);
  return with.rotating;
}

}  // namespace

const std::array<const char*, 6> component_names{"x", "y", "z", "rx", "ry", "rz"};

std::optional<int> DofMap::dof_of_number(int active, int component) const
{
  const auto it = std::ranges::find(components_, component);
  if (it == components_.end()) return std::nullopt;
  return n_components() * active + static_cast<int>(it - components_.begin());
}

std::optional<int> DofMap::dof(int node, int component) const
{
  if (is_dependent(node)) return std::nullopt;
  const auto it = combined.find(node);
  return dof_at(it == combined.end() ? coordinate(node, component)
                                     : it->second.coordinates[std::size_t(component)]);
}

std::vector<int> DofMap::unused_dofs() const
{
  std::vector<int> dofs;
  for (const int coordinate : unused)
    if (const auto dof = dof_at(coordinate)) dofs.push_back(*dof);
  return dofs;
}

std::vector<int> DofMap::own_numbers(int node) const
{
  std::vector<int> numbers;
  for (const MotionTerm& term : motion(node)) numbers.push_back(term.number);
  const auto found = combined.find(is_dependent(node) ? reference(node) : node);
  if (found != combined.end() && found->second.n_own > 0)
    numbers.resize(std::size_t(found->second.n_own));
  return numbers;
}

std::optional<int> DofMap::harmonic_dof(const HarmonicRing& ring, int k, int component) const
{
  return dof_at(coordinate(ring.nodes[std::size_t(k)], component));
}

std::optional<int> DofMap::dof_at(int coordinate) const
{
  return coordinate < 0 ? std::nullopt : dof_of_number(coordinate / 6, coordinate % 6);
}

bool DofMap::holds(int component) const
{
  return rotating.empty() && !std::ranges::binary_search(components_, component);
}

std::vector<int> DofMap::components_of(int node) const
{
  if (rotating.empty() || !has_rotations(node)) return components_;
  return {0, 1, 2, 3, 4, 5};
}

namespace {

/// A node on a face moves as that alone does.
void refuse_couplings_of_face_nodes(const mesh::Mesh& mesh, std::span<const Coupling> couplings)
{
  for (const Coupling& coupling : couplings) {
    for (const mesh::Group& group : mesh.groups) {
      if (group.name != coupling.group && group.name != coupling.to) continue;
      for (const mesh::FaceNode& on_face : mesh.face_nodes) {
        if (std::ranges::find(group.nodes, on_face.node) == group.nodes.end()) continue;
        throw Error(
            fmt::format("{}: \"{}\" has nodes on faces (on = \"face\"), which follow those and no "
                        "coupling; couple a group of nodes of the mesh",
                        describe(coupling), group.name));
      }
    }
  }
}

}  // namespace

DofMap make_dof_map(const mesh::Mesh& mesh, const Kinematics& kinematics,
                    std::span<const int> owners, int n_ranks)
{
  const std::span<const Coupling> couplings = kinematics.couplings;
  refuse_couplings_of_face_nodes(mesh, couplings);
  CoupledNodes coupled = follow_references(mesh, couplings);
  coupled.rotating = rotating_nodes(mesh, couplings, coupled);
  const bool has_solids = !coupled.rotating.empty();
  std::vector<int> numbering(owners.begin(), owners.end());
  for (const mesh::FaceNode& on_face : mesh.face_nodes)  // it takes the number of another node
    numbering[std::size_t(on_face.node)] = -1;
  NumberedNodes numbered = number_nodes(std::move(coupled), couplings, numbering, n_ranks);
  NodeMotions averaged = average_motions(mesh, couplings, face_motions(mesh, std::move(numbered)));
  NodeMotions solved = equation_motions(mesh, std::move(averaged));
  check_components(mesh, kinematics);
  return {with_ring_harmonics(mesh, std::move(solved), kinematics.rings),
          has_solids ? std::vector{0, 1, 2} : kinematics.components};
}

namespace {

constexpr double placement = 1e-6;  // of angles in rad, of lengths relative to the radius

/// The nodes of a circle by their angle, and the directions of the circle.
struct Circle {
  std::vector<int> nodes;
  VectorXd angles;  ///< rad
  Matrix3d axes;    ///< columns: phi = 0, phi = 90 degrees, axis
};

/// The vector itself, or the coordinate axis that it is to round-off.
Vector3d without_round_off(const Vector3d& v)
{
  for (int k = 0; k < 3; ++k)
    if ((v - Vector3d::Unit(k)).norm() < 1e-8) return Vector3d::Unit(k);
  return v;
}

/// From the plane that fits the nodes best.
Matrix3d axes_of(const Eigen::Matrix3Xd& arms)
{
  const Eigen::SelfAdjointEigenSolver<Matrix3d> plane(arms * arms.transpose());
  Vector3d axis = plane.eigenvectors().col(0);
  Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  if (axis[largest] < 0.0) axis = -axis;
  axis = without_round_off(axis);
  const Vector3d from = std::abs(axis.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d e_1 = (from - axis.dot(from) * axis).normalized();
  Matrix3d axes;
  axes << e_1, axis.cross(e_1), axis;
  return axes;
}

/// Refuses what is not equally spaced on a circle.
void check_circle(const CoupledNodes& nodes, const Circle& circle, const Eigen::Matrix3Xd& arms,
                  const std::string& ring)
{
  const Index n = circle.angles.size();
  const double radius = arms.colwise().norm().mean();
  const double step = 2.0 * std::numbers::pi / static_cast<double>(n);
  for (Index i = 0; i < n; ++i) {
    const Vector3d local = circle.axes.transpose() * arms.col(i);
    const double angle = circle.angles[0] + static_cast<double>(i) * step;
    if (std::abs(local.head<2>().norm() - radius) > placement * radius ||
        std::abs(local.z()) > placement * radius ||
        std::abs(circle.angles[i] - angle) > placement) {
      const Vector3d x = nodes.position(circle.nodes[static_cast<std::size_t>(i)]);
      throw Error(
          fmt::format("ring \"{}\": its {} nodes are not equally spaced on a circle, as harmonics "
                      "need them; the one at ({:.6g}, {:.6g}, {:.6g}) is off its place. Take the "
                      "ring out of interface.rings, or make it by mesh.rings",
                      ring, n, x[0], x[1], x[2]));
    }
  }
}

Circle circle_of(const CoupledNodes& nodes, const std::vector<int>& group, const std::string& ring)
{
  const Index n = std::ssize(group);
  if (n < 3) throw Error(fmt::format("ring \"{}\": {} nodes make no ring; take three", ring, n));
  Eigen::Matrix3Xd arms(3, n);
  for (Index i = 0; i < n; ++i) arms.col(i) = nodes.position(group[std::size_t(i)]);
  arms.colwise() -= arms.rowwise().mean().eval();
  const Matrix3d axes = axes_of(arms);
  std::vector<std::pair<double, Index>> order;
  for (Index i = 0; i < n; ++i) {
    const Vector3d local = axes.transpose() * arms.col(i);
    double angle = std::atan2(local.y(), local.x());
    if (std::abs(angle) < placement * placement) angle = 0.0;
    order.emplace_back(angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle, i);
  }
  std::ranges::sort(order);
  Circle circle{.nodes = {}, .angles = VectorXd(n), .axes = axes};
  Eigen::Matrix3Xd sorted(3, n);
  for (Index i = 0; i < n; ++i) {
    const auto [angle, k] = order[static_cast<std::size_t>(i)];
    circle.nodes.push_back(group[static_cast<std::size_t>(k)]);
    circle.angles[i] = angle;
    sorted.col(i) = arms.col(k);
  }
  check_circle(nodes, circle, sorted, ring);
  return circle;
}

/// F: column 0 is 1, columns 2 n - 1 and 2 n are cos(n phi) and sin(n phi), all of length 1.
/// Counted from the first node, so that the highest harmonic of an even ring has its cosine there.
MatrixXd harmonics(const VectorXd& angles)
{
  const Index n = angles.size();
  MatrixXd F(n, n);
  for (Index k = 0; k < n; ++k) {
    const Harmonic harmonic = harmonic_of(static_cast<int>(k));
    const double start = 2 * harmonic.order == n ? angles[0] : 0.0;
    for (Index i = 0; i < n; ++i) {
      const double phase = harmonic.order * (angles[i] - start);
      F(i, k) = harmonic.is_sine ? std::sin(phase) : std::cos(phase);
    }
    F.col(k).normalize();
  }
  return (F.array().abs() < 1e-14).select(0.0, F);
}

/// diag(E, E) with E = (e_r, e_t, e_a) at an angle.
Matrix6d directions(const Matrix3d& axes, double angle)
{
  Matrix3d turn = Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  Matrix6d E = Matrix6d::Zero();
  E.topLeftCorner<3, 3>() = E.bottomRightCorner<3, 3>() = axes * turn;
  return (E.array().abs() < 1e-14).select(0.0, E);
}

/// Active numbers that averages combine.
std::set<int> averaged_numbers(const NodeMotions& motions)
{
  std::set<int> numbers;
  for (const auto& [node, motion] : motions.combined) {
    if (motion.by_faces) continue;
    for (const MotionTerm& term : motion.terms) numbers.insert(term.number);
  }
  return numbers;
}

/// Refuses nodes that do not stand on their own DOFs.
void check_nodes(const NodeMotions& motions, const Circle& circle, const std::string& ring)
{
  const std::set<int> averaged = averaged_numbers(motions);
  for (const int node : circle.nodes) {
    if (motions.has_rotations(node) != motions.has_rotations(circle.nodes.front())) {
      throw Error(fmt::format(
          "ring \"{}\": some of its nodes belong to solids and have no rotations, others "
          "have; make it of one kind",
          ring));
    }
    const bool is_free = motions.is_independent(node) && !averaged.contains(motions.number(node));
    if (is_free) continue;
    const std::string& other = motions.followed(node);
    throw Error(fmt::format(
        "ring \"{}\": its nodes {}; harmonics need nodes that belong to no coupling and to no "
        "other ring of harmonics",
        ring,
        other.empty() ? "take part in an average or an equation"
                      : fmt::format("follow \"{}\"", other)));
  }
}

void check_order(const RingHarmonics& wanted, std::size_t n)
{
  if (wanted.up_to >= 1 && 2 * wanted.up_to <= static_cast<int>(n)) return;
  throw Error(fmt::format(
      "ring \"{}\": harmonics = {}, but {} nodes show the harmonics 1 to {} only; give fewer, or "
      "more nodes to the ring",
      wanted.ring, wanted.up_to, n, n / 2));
}

}  // namespace

RingMotions with_ring_harmonics(const mesh::Mesh& mesh, NodeMotions motions,
                                std::span<const RingHarmonics> rings)
{
  RingMotions with{std::move(motions), {}};
  for (const RingHarmonics& wanted : rings) {
    const Circle circle = circle_of(with, with.named_nodes(mesh, wanted.ring), wanted.ring);
    check_nodes(with, circle, wanted.ring);
    check_order(wanted, circle.nodes.size());
    const MatrixXd F = harmonics(circle.angles);
    HarmonicRing ring{
        .name = wanted.ring, .up_to = wanted.up_to, .nodes = circle.nodes, .numbers = {}};
    for (const int node : circle.nodes) ring.numbers.push_back(with.number(node));
    std::map<int, std::vector<MotionTerm>> became;
    for (Index i = 0; i < F.rows(); ++i) {
      const Matrix6d E = directions(circle.axes, circle.angles[i]);
      CombinedMotion motion{.followed = wanted.ring, .terms = {}, .coordinates = {}};
      motion.coordinates.fill(-1);
      for (Index k = 0; k < F.cols(); ++k)
        for (const MotionTerm& own : with.own_motion(circle.nodes[std::size_t(k)]))
          motion.terms.push_back({own.number, F(i, k) * (E * own.T)});
      const int node = circle.nodes[static_cast<std::size_t>(i)];
      became.emplace(with.number(node), motion.terms);
      with.combined.emplace(node, std::move(motion));
    }
    rewrite_by_faces(with, became);
    with.rings.push_back(std::move(ring));
  }
  return with;
}

namespace {

[[noreturn]] void refuse_dependent(const mesh::Mesh& mesh, const DofMap& dofs,
                                   const Support& support, int node)
{
  const std::string& followed = dofs.followed(node);
  throw Error(fmt::format("support of \"{}\": node {} follows \"{}\"; support \"{}\" instead",
                          support.group, mesh.node_numbers[node], followed, followed));
}

/// A component that equations make of others is at rest if these are held.
void check_at_rest(const mesh::Mesh& mesh, const DofMap& dofs, const std::vector<int>& held,
                   const Support& support, int node, int component)
{
  const auto has_node = [&](const mesh::Equation& equation) {
    return std::ranges::find(equation.terms, node, &mesh::Equation::Term::node) !=
           equation.terms.end();
  };
  const auto equation = std::ranges::find_if(mesh.equations, has_node);
  if (equation == mesh.equations.end()) {
    if (component >= 3 && !dofs.has_rotations(node)) return;
    refuse_dependent(mesh, dofs, support, node);
  }
  for (const MotionTerm& term : dofs.motion(node)) {
    for (int c = 0; c < 6; ++c) {
      const auto dof = dofs.dof_of_number(term.number, c);
      if (term.T(component, c) == 0.0 || !dof || std::ranges::binary_search(held, *dof)) continue;
      throw Error(
          fmt::format("support of \"{}\": {} of node {} follows other nodes by an equation ({}); "
                      "hold these, or "
                      "take the node out",
                      support.group, component_names[std::size_t(component)],
                      mesh.node_numbers[node], equation->place));
    }
  }
}

/// Rotations beside displacements are of no consequence: a solid has none that could move.
void refuse_rotations_of_solids(const mesh::Mesh& mesh, const DofMap& dofs, const Support& support,
                                int node)
{
  const auto is_rotation = [](int component) { return component >= 3; };
  if (dofs.has_rotations(node) || !std::ranges::all_of(support.components, is_rotation)) return;
  throw Error(
      fmt::format("support of \"{}\": node {} of a solid has no rotations to hold; hold x, y, z of "
                  "its face, or couple that rigidly ([[coupling]]) and hold the coupling",
                  support.group, mesh.node_numbers[node]));
}

}  // namespace

std::vector<int> held_dofs(const mesh::Mesh& mesh, const DofMap& dofs,
                           std::span<const Support> supports)
{
  std::vector<int> held;
  std::vector<std::tuple<const Support*, int, int>> combined;  // node, component
  for (const Support& support : supports) {
    const std::vector<int> nodes = dofs.named_nodes(mesh, support.group);
    if (nodes.empty())
      throw Error(fmt::format("support of \"{}\": the group has no nodes", support.group));
    for (const int node : nodes) {
      refuse_rotations_of_solids(mesh, dofs, support, node);
      for (const int component : support.components) {
        const auto dof = dofs.dof(node, component);
        if (dof)
          held.push_back(*dof);
        else if (!dofs.is_plain(node))  // else the model holds it, or a solid has none
          combined.emplace_back(&support, node, component);
      }
    }
  }
  std::ranges::sort(held);
  held.erase(std::unique(held.begin(), held.end()), held.end());
  for (const auto& [support, node, component] : combined)
    check_at_rest(mesh, dofs, held, *support, node, component);
  return held;
}

}  // namespace chladni::plate
