#include "squeal/assembly/joints.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/attachment_dofs.hpp"

namespace chladni::squeal {

using Eigen::Vector3d;
using mbs_export::component_name;

Part placed(const PartOptions& options, const mbs_export::ModalBody& body)
{
  using Eigen::AngleAxisd, Eigen::Vector3d;
  const auto& [a_x, a_y, a_z] = options.rotation;
  const Eigen::Matrix3d R =
      (AngleAxisd(a_z, Vector3d::UnitZ()) * AngleAxisd(a_y, Vector3d::UnitY()) *
       AngleAxisd(a_x, Vector3d::UnitX()))
          .toRotationMatrix();
  const Vector3d origin(options.position[0], options.position[1], options.position[2]);
  const Eigen::Index n = body.n_modes(), n_nodes = std::ssize(body.attachment_nodes);
  Part part{.name = options.name,
            .file = options.body,
            .omega = body.omega,
            .C = body.C.size() > 0 ? body.C : Eigen::MatrixXd::Zero(n, n),
            .positions = Eigen::Matrix3Xd(3, n_nodes),
            .Phi = Eigen::MatrixXd(6 * n_nodes, n),
            .R = R,
            .moves = (body.attachment_modes.array() != 0.0).rowwise().any().reshaped(6, n_nodes),
            .drilling = Eigen::Matrix3Xd(3, n_nodes),
            .sets = body.sets};
  for (Eigen::Index i = 0; i < n_nodes; ++i) {
    const auto& node = body.attachment_nodes[static_cast<std::size_t>(i)];
    part.positions.col(i) = origin + R * node.position;
    part.drilling.col(i) = R * node.drilling_axis;
    for (const Eigen::Index row : {6 * i, 6 * i + 3})
      part.Phi.middleRows<3>(row) = R * body.attachment_modes.middleRows<3>(row);
  }
  return part;
}

const std::vector<int>& nodes_of(const Part& part, const std::string& set, const std::string& key)
{
  const auto found = std::ranges::find(part.sets, set, &mbs_export::AttachmentSet::name);
  if (found != part.sets.end() && !found->nodes.empty()) return found->nodes;
  std::vector<std::string> names;
  for (const auto& other : part.sets) names.push_back(other.name);
  throw Error(fmt::format("{}: part \"{}\" ({}) has no attachment nodes \"{}\"; it has: \"{}\"",
                          key, part.name, part.file, set, fmt::join(names, "\", \"")));
}

Eigen::MatrixXd motion_at(const Part& part, int node, const Eigen::Vector3d& point)
{
  Eigen::MatrixXd motion = part.Phi.middleRows<6>(6 * Eigen::Index{node});
  const Eigen::Vector3d arm = point - part.positions.col(node);
  // u + theta x arm
  for (Eigen::Index j = 0; j < motion.cols(); ++j)
    motion.col(j).head<3>() += motion.col(j).tail<3>().cross(arm).eval();
  return motion;
}

namespace {

/// Normals of a mesh of a curved shell, and axes of parts that were turned, are as exact as that.
constexpr double tilt = 1e-2, mixing = 1e-9;

std::string set_of(const Part& part, const std::string& set)
{
  return fmt::format("\"{}.{}\" ({})", part.name, set, part.file);
}

/// Whether a node moves, but does not turn.
bool lacks_rotations(const Part& part, int node)
{
  const auto moves = part.moves.col(node);
  return moves.head<3>().any() && !moves.tail<3>().any();
}

/// A component in the axes of the body, which the whole set lacks or a node of it does.
bool is_lacking(const Part& part, const std::vector<int>& nodes, Eigen::Index own)
{
  const bool none = std::ranges::none_of(nodes, [&](int node) { return part.moves(own, node); });
  return none ||
         (own >= 3 && std::ranges::any_of(nodes, [&](int i) { return lacks_rotations(part, i); }));
}

}  // namespace

Components needed_of_node(const Components& of_point, const Eigen::Vector3d& arm, double tolerance)
{
  Components needed = of_point;
  // u + theta x arm
  for (std::size_t c = 0; c < 3; ++c)
    for (const std::size_t other : {(c + 1) % 3, (c + 2) % 3})
      if (of_point[c] && std::abs(arm[static_cast<Eigen::Index>(3 - c - other)]) > tolerance)
        needed[3 + other] = true;
  return needed;
}

void require_components(const Part& part, const std::string& set, const Components& needed,
                        const std::string& key, const std::string& remedy)
{
  const std::vector<int>& nodes = nodes_of(part, set, key);
  for (Eigen::Index c = 0; c < 6; ++c)
    for (Eigen::Index axis = 0; needed[static_cast<std::size_t>(c)] && axis < 3; ++axis) {
      const Eigen::Index own = c < 3 ? axis : 3 + axis;
      if (std::abs(part.R(c % 3, axis)) <= mixing || !is_lacking(part, nodes, own)) continue;
      throw Error(fmt::format(
          "{}: the modes of {} have no component {} there ({} of the body's own axes is zero in "
          "modes/attachment_displacements: the body lacks it or holds it); {}",
          key, set_of(part, set), component_name(int(c)), component_name(int(own)), remedy));
    }
}

void refuse_drilling(const Part& part, const std::string& set, const Components& components,
                     const std::string& key)
{
  for (const int node : nodes_of(part, set, key))
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!components[3 + axis]) continue;
      if (std::abs(part.drilling(static_cast<Eigen::Index>(axis), node)) <= tilt) continue;
      const char* name = component_name(static_cast<int>(3 + axis));
      throw Error(fmt::format(
          "{}: {} of {} turns nodes about the normal of a smooth shell, which elements resist by a "
          "numerical stiffness alone; take {} out of the joint, or couple a group of nodes rigidly "
          "([[coupling]], type \"rigid\") in the scene of that body and join the coupling's name",
          key, name, set_of(part, set), name));
    }
}

Eigen::Matrix3Xd axes_without_drilling(const Eigen::Matrix<double, 3, 2>& normals)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spins(normals * normals.transpose());
  // In ascending order.
  const Eigen::Index n_free = (spins.eigenvalues().array() <= tilt * tilt).count();
  return spins.eigenvectors().leftCols(n_free);
}

namespace {

/// Meshes give places of nodes to this part of the size of a part.
constexpr double placement = 1e-6;

/// Two nodes that a joint joins; the second one is absent for the ground.
struct NodePair {
  int first, second;
};

std::string name_of_nodes(const PartNodes& nodes)
{
  return fmt::format("{}.{}", nodes.part, nodes.set);
}

double size_of_part(const Part& part)
{
  return (part.positions.rowwise().maxCoeff() - part.positions.rowwise().minCoeff()).norm();
}

void check_distance(const JointOptions& joint, const std::string& key, const Part& a, const Part& b,
                    double distance)
{
  const double size = std::max(size_of_part(a), size_of_part(b));
  if (distance <= joint.span + placement * size) return;
  // No joint is longer than the parts that it joins.
  const std::string bridge =
      distance > size
          ? std::string()
          : fmt::format(", or give span = {:.3g} to join them rigidly over that distance",
                        1.1 * distance);
  throw Error(fmt::format(
      "{}: nodes of \"{}\" and \"{}\" are {:.6g} m apart; move a part by its position ({} and {} "
      "may have other units or origins){}",
      key, name_of_nodes(joint.ends[0]), name_of_nodes(joint.ends[1]), distance, a.file, b.file,
      bridge));
}

/// Each node of the first set with the nearest one of the second set.
std::vector<NodePair> pairs_of(const JointOptions& joint, const std::string& key, const Part& a,
                               const Part& b)
{
  const std::vector<int>& first = nodes_of(a, joint.ends[0].set, key);
  const std::vector<int>& second = nodes_of(b, joint.ends[1].set, key);
  std::vector<NodePair> pairs;
  std::vector<int> free = second;
  for (const int i : first) {
    if (free.empty()) break;
    const Vector3d x = a.positions.col(i);
    const auto nearest =
        std::ranges::min_element(free, {}, [&](int j) { return (b.positions.col(j) - x).norm(); });
    check_distance(joint, key, a, b, (b.positions.col(*nearest) - x).norm());
    pairs.push_back({i, *nearest});
    free.erase(nearest);
  }
  if (first.size() != second.size()) {
    throw Error(fmt::format(
        "{}: \"{}\" has {} nodes and \"{}\" has {}; a joint joins them one by one", key,
        name_of_nodes(joint.ends[0]), first.size(), name_of_nodes(joint.ends[1]), second.size()));
  }
  return pairs;
}

std::vector<NodePair> pairs_to_ground(const JointOptions& joint, const std::string& key,
                                      const Part& part)
{
  std::vector<NodePair> pairs;
  for (const int i : nodes_of(part, joint.ends[0].set, key)) pairs.push_back({i, -1});
  return pairs;
}

/// Places of the parts' coordinates.
struct PartPlaces {
  std::span<const Part> parts;
  std::vector<Eigen::Index> first;
};

Components components_of(const JointOptions& joint)
{
  Components components{};
  for (const int c : joint.rigid) components[static_cast<std::size_t>(c)] = true;
  for (std::size_t c = 0; c < components.size(); ++c)
    if (joint.stiffness[c] > 0.0 || joint.damping[c] > 0.0) components[c] = true;
  return components;
}

/// An end of a joint can take what the joint does to it.
/// @param arms  [3 x n_pairs] from the nodes to where the joint acts, m
void check_end(const JointOptions& joint, const PartNodes& end, const Part& part,
               const Eigen::Matrix3Xd& arms, const std::string& key)
{
  const Components components = components_of(joint);
  Components needed = components;
  for (Eigen::Index i = 0; i < arms.cols(); ++i) {
    const Components of_node =
        needed_of_node(components, arms.col(i), placement * size_of_part(part));
    for (std::size_t c = 0; c < needed.size(); ++c) needed[c] = needed[c] || of_node[c];
  }
  require_components(part, end.set, needed, key,
                     joint.rigid.empty()
                         ? "take it out of stiffness and damping, or give the body nodes that have "
                           "it (a rotation carries the joint over its span, too)"
                         : "name in dofs what both ends have, or give the body nodes that have it "
                           "(a rotation carries the joint over its span, too)");
  if (!joint.spares_drilling) refuse_drilling(part, end.set, components, key);
}

/// What a joint sees of two nodes.
struct JointMotion {
  Eigen::MatrixXd motion;               ///< [6 x n] relative, at the point between them
  Eigen::Matrix<double, 3, 2> normals;  ///< of smooth shells at the nodes, else zero
};

/// Relative motion of each pair of nodes of a joint.
std::vector<JointMotion> relative_motions(const PartPlaces& places, const JointOptions& joint,
                                          const std::string& key)
{
  const std::size_t i = part_index(places.parts, joint.ends[0].part);
  const Part& a = places.parts[i];
  const bool grounded = joint.ends[1].is_ground();
  const std::size_t j = grounded ? i : part_index(places.parts, joint.ends[1].part);
  const Part& b = places.parts[j];
  const std::vector<NodePair> pairs =
      grounded ? pairs_to_ground(joint, key, a) : pairs_of(joint, key, a, b);
  std::vector<JointMotion> motions;
  Eigen::Matrix3Xd arms_a(3, std::ssize(pairs)), arms_b = arms_a;
  for (const auto& [first, second] : pairs) {
    const auto at = std::ssize(motions);
    Vector3d point = a.positions.col(first);
    if (!grounded) point = 0.5 * (point + b.positions.col(second));
    JointMotion pair{.motion = Eigen::MatrixXd::Zero(6, places.first.back()), .normals = {}};
    pair.normals << a.drilling.col(first), Vector3d::Zero();
    pair.motion.middleCols(places.first[i], a.n_modes()) += motion_at(a, first, point);
    arms_a.col(at) = point - a.positions.col(first);
    if (!grounded) {
      pair.motion.middleCols(places.first[j], b.n_modes()) -= motion_at(b, second, point);
      pair.normals.col(1) = b.drilling.col(second);
      arms_b.col(at) = point - b.positions.col(second);
    }
    motions.push_back(std::move(pair));
  }
  check_end(joint, joint.ends[0], a, arms_a, key);
  if (!grounded) check_end(joint, joint.ends[1], b, arms_b, key);
  return motions;
}

/// What a rigid joint sets to zero of the relative motion of two nodes.
Eigen::MatrixXd rigid_rows(const JointOptions& joint, const JointMotion& pair)
{
  if (!joint.spares_drilling) return pair.motion(joint.rigid, every);
  const Eigen::Matrix3Xd axes = axes_without_drilling(pair.normals);
  Eigen::MatrixXd rows(3 + axes.cols(), pair.motion.cols());
  rows << pair.motion.topRows<3>(), axes.transpose() * pair.motion.bottomRows<3>();
  return rows;
}

void append_rows(Eigen::MatrixXd& B, const Eigen::MatrixXd& rows)
{
  B.conservativeResize(B.rows() + rows.rows(), rows.cols());
  B.bottomRows(rows.rows()) = rows;
}

/// Says so where a rigid joint holds more of bodies that bend than it leaves.
/// @param B     [n_rigid x n] of the joint
/// @param name  "joint[1]"
std::optional<std::string> note_of_locking(const PartPlaces& places, const JointOptions& joint,
                                           const Eigen::MatrixXd& B, const std::string& name)
{
  Eigen::Index n = 0;
  std::string names;
  bool bends = false;
  for (const PartNodes& end : joint.ends) {
    if (end.is_ground()) continue;
    const Part& part = places.parts[part_index(places.parts, end.part)];
    n += part.n_modes();
    bends = bends || (part.omega.array() > 0.0).any();
    names += fmt::format("{}\"{}\"", names.empty() ? "" : " and ", part.name);
  }
  const Eigen::Index taken = B.cols() - null_space(B).cols();
  if (!bends || 2 * taken <= n) return std::nullopt;
  return fmt::format(
      "{} takes {} of the {} coordinates of {}, which can hardly bend then; join fewer nodes, add "
      "interface modes there, or use springs",
      name, taken, n, names);
}

}  // namespace

std::vector<Eigen::Index> first_coordinates(std::span<const Part> parts)
{
  std::vector<Eigen::Index> first{0};
  for (const Part& part : parts) first.push_back(first.back() + part.n_modes());
  return first;
}

std::size_t part_index(std::span<const Part> parts, const std::string& name)
{
  const auto found = std::ranges::find(parts, name, &Part::name);
  if (found == parts.end()) throw Error(fmt::format("there is no part \"{}\" to join", name));
  return static_cast<std::size_t>(found - parts.begin());
}

JoinedParts joined(std::span<const Part> parts, std::span<const JointOptions> joints)
{
  const PartPlaces places{parts, first_coordinates(parts)};
  const Eigen::Index n = places.first.back();
  JoinedParts all{.K = Eigen::MatrixXd::Zero(n, n),
                  .C = Eigen::MatrixXd::Zero(n, n),
                  .B = Eigen::MatrixXd(0, n),
                  .notes = {}};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    const Eigen::Index at = places.first[i], m = part.n_modes();
    all.K.block(at, at, m, m).diagonal() = part.omega.cwiseAbs2();
    all.C.block(at, at, m, m) = part.C;
  }
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JointOptions& joint = joints[i];
    const Eigen::Map<const Eigen::Vector<double, 6>> k(joint.stiffness.data());
    const Eigen::Map<const Eigen::Vector<double, 6>> d(joint.damping.data());
    const std::string name = fmt::format("joint[{}]", i + 1);
    Eigen::MatrixXd B(0, n);
    for (const JointMotion& pair : relative_motions(places, joint, name + ".between")) {
      if (!joint.rigid.empty()) append_rows(B, rigid_rows(joint, pair));
      all.K += pair.motion.transpose() * k.asDiagonal() * pair.motion;
      all.C += pair.motion.transpose() * d.asDiagonal() * pair.motion;
    }
    append_rows(all.B, B);
    if (const auto note = note_of_locking(places, joint, B, name)) all.notes.push_back(*note);
  }
  return all;
}

Eigen::MatrixXd null_space(const Eigen::MatrixXd& B)
{
  const Eigen::Index n = B.cols();
  // Rows of displacements and of rotations have different units.
  Eigen::MatrixXd rows = B.transpose();
  Eigen::Index n_rows = 0;
  for (Eigen::Index i = 0; i < rows.cols(); ++i)
    if (const double norm = rows.col(i).norm(); norm > 0.0) rows.col(n_rows++) = rows.col(i) / norm;
  if (n_rows == 0) return Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd scaled = rows.leftCols(n_rows);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
  // What two joints ask for twice is asked for once.
  qr.setThreshold(1e-9);
  const Eigen::MatrixXd Q = linear::columns_of_Q(qr, n);
  return Q.rightCols(n - qr.rank());
}

}  // namespace chladni::squeal
