#include "squeal/assembly/joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Vector3d;

/// Meshes give places of nodes to this part of the size of a part.
constexpr double placement = 1e-6;

/// Two nodes that a joint joins; the second one is absent for the ground.
struct NodePair {
  int first, second;
};

std::string name_of(const PartNodes& nodes)
{
  return fmt::format("{}.{}", nodes.part, nodes.set);
}

double size_of(const Part& part)
{
  return (part.positions.rowwise().maxCoeff() - part.positions.rowwise().minCoeff()).norm();
}

void check_distance(const JointOptions& joint, const std::string& key, const Part& a, const Part& b,
                    double distance)
{
  const double size = std::max(size_of(a), size_of(b));
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
      key, name_of(joint.ends[0]), name_of(joint.ends[1]), distance, a.file, b.file, bridge));
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
    throw Error(
        fmt::format("{}: \"{}\" has {} nodes and \"{}\" has {}; a joint joins them one by one", key,
                    name_of(joint.ends[0]), first.size(), name_of(joint.ends[1]), second.size()));
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
struct Places {
  std::span<const Part> parts;
  std::vector<Eigen::Index> first;
};

/// [6 x n] relative motion of each pair of nodes of a joint, at the point between them.
std::vector<Eigen::MatrixXd> relative_motions(const Places& places, const JointOptions& joint,
                                              const std::string& key)
{
  const std::size_t i = part_index(places.parts, joint.ends[0].part);
  const Part& a = places.parts[i];
  const bool grounded = joint.ends[1].is_ground();
  const std::size_t j = grounded ? i : part_index(places.parts, joint.ends[1].part);
  const Part& b = places.parts[j];
  std::vector<Eigen::MatrixXd> motions;
  for (const auto& [first, second] :
       grounded ? pairs_to_ground(joint, key, a) : pairs_of(joint, key, a, b)) {
    Vector3d point = a.positions.col(first);
    if (!grounded) point = 0.5 * (point + b.positions.col(second));
    Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(6, places.first.back());
    motion.middleCols(places.first[i], a.n_modes()) += motion_at(a, first, point);
    if (!grounded) motion.middleCols(places.first[j], b.n_modes()) -= motion_at(b, second, point);
    motions.push_back(std::move(motion));
  }
  return motions;
}

void add_rigid(JoinedParts& all, const Eigen::MatrixXd& motion, const std::vector<int>& components)
{
  for (const int c : components) {
    all.B.conservativeResize(all.B.rows() + 1, all.K.cols());
    all.B.bottomRows<1>() = motion.row(c);
  }
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
  const Places places{parts, first_coordinates(parts)};
  const Eigen::Index n = places.first.back();
  JoinedParts all{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd(0, n)};
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
    for (const Eigen::MatrixXd& motion :
         relative_motions(places, joint, fmt::format("joint[{}].between", i + 1))) {
      add_rigid(all, motion, joint.rigid);
      all.K += motion.transpose() * k.asDiagonal() * motion;
      all.C += motion.transpose() * d.asDiagonal() * motion;
    }
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
  const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(n, n);
  return Q.rightCols(n - qr.rank());
}

}  // namespace chladni::squeal
