#include "plate/dofs/average_motions.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <map>

#include "common/error.hpp"
#include "plate/dofs/group_shares.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr double no_rotation = 1e-9;  // of the largest pivot

/// The blocks of a row of six equations, by active number.
using Blocks = std::map<int, Matrix6d>;

/// The motion of the reference node as the mean of its group: A q.
/// @param shares  of the nodes of the group, their weights
Blocks mean_motion(const NodeMotions& motions, const std::map<int, double>& shares, int reference)
{
  double sum = 0.0;
  Vector3d centre = Vector3d::Zero();
  for (const auto& [node, share] : shares) {
    sum += share;
    centre += share * motions.position(node);
  }
  centre /= sum;
  Matrix3d J = Matrix3d::Zero();
  for (const auto& [node, share] : shares) {
    const Matrix3d r = cross_matrix(motions.position(node) - centre);
    J -= share / sum * r * r;
  }
  const Matrix3d J_inverse = J.completeOrthogonalDecomposition().pseudoInverse();
  const Matrix6d to_reference = rigid_arm(motions.position(reference) - centre);
  Blocks A;
  for (const auto& [node, share] : shares) {
    const double w = share / sum;
    Matrix6d of_node = Matrix6d::Zero();
    of_node.topLeftCorner<3, 3>() = w * Matrix3d::Identity();
    of_node.bottomLeftCorner<3, 3>() =
        w * J_inverse * cross_matrix(motions.position(node) - centre);
    for (const MotionTerm& term : motions.motion(node))
      A.try_emplace(term.number, Matrix6d::Zero()).first->second += to_reference * of_node * term.T;
  }
  return A;
}

/// The six columns of A that are solved for: DOFs, ascending by pivoting, and their block inverted.
struct Pivots {
  std::array<int, 6> dof;
  Matrix6d inverse;
};

/// Rows of rotation are scaled by the size of the group, so that all are lengths.
Pivots choose_pivots(const Blocks& A, double length, const Coupling& coupling)
{
  MatrixXd columns = MatrixXd::Zero(6, 3 * static_cast<Index>(A.size()));
  std::vector<int> dof;
  for (const auto& [number, block] : A) {
    for (int c = 0; c < 3; ++c) {  // displacements only
      columns.col(std::ssize(dof)) = block.col(c);
      dof.push_back(6 * number + c);
    }
  }
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
  CombinedMotion motion{.followed = {}, .terms = {}, .dof = pivots.dof};
  for (const auto& [number, block] : T) motion.terms.push_back({number, block});
  return motion;
}

/// The motion of a node that holds pivots: those displacements are P^-1 (u_ref - A_rest q_rest).
CombinedMotion pivot_node_motion(int number, const Blocks& A, const Pivots& pivots)
{
  CombinedMotion motion{.followed = {}, .terms = {}, .dof = {}};
  for (int c = 0; c < 6; ++c) motion.dof[c] = 6 * number + c;
  Blocks T;
  T[number] = Matrix6d::Identity();
  for (int k = 0; k < 6; ++k) {
    if (pivots.dof[k] / 6 != number) continue;
    const int component = pivots.dof[k] % 6;
    motion.dof[component] = -1;
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
    terms.push_back({.number = number(end), .T = Matrix6d::Identity()});
  if (end == node) return terms;
  const Matrix6d T = rigid_arm(arm(node));
  for (MotionTerm& term : terms) term.T = T * term.T;
  return terms;
}

const std::string& NodeMotions::followed(int node) const
{
  const auto it = combined.find(node);
  return it == combined.end() ? names_followed[node] : it->second.followed;
}

NodeMotions average_motions(const mesh::Mesh& mesh, std::span<const Coupling> couplings,
                            NumberedNodes nodes)
{
  NodeMotions motions{std::move(nodes), {}};
  std::map<int, int> claimed;
  std::vector<int> node_of(motions.n_active(), -1);
  for (int node = 0; node < motions.n_nodes(); ++node)
    if (motions.number(node) >= 0) node_of[motions.number(node)] = node;
  for (int i = 0; i < std::ssize(couplings); ++i) {
    if (couplings[i].kind != CouplingKind::averaging) continue;
    const std::vector<int>& group = mesh::find_group(mesh, couplings[i].group).nodes;
    const int reference = motions.reference_node(couplings[i].name).value();
    refuse_followers(motions, mesh, couplings[i]);
    const Blocks A = mean_motion(motions, group_shares(mesh, couplings[i].group), reference);
    claim(A, claimed, i, couplings);
    const Pivots pivots = choose_pivots(A, size_of(motions, group, reference), couplings[i]);
    motions.combined.emplace(reference, reference_motion(pivots));
    for (const int dof : pivots.dof) {
      const int node = node_of[dof / 6];
      if (motions.combined.contains(node)) continue;
      CombinedMotion motion = pivot_node_motion(dof / 6, A, pivots);
      motion.followed = couplings[i].name;
      motions.combined.emplace(node, std::move(motion));
    }
  }
  return motions;
}

}  // namespace chladni::plate
