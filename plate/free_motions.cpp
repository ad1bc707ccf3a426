#include "plate/free_motions.hpp"

#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using RowVector6d = Eigen::Matrix<double, 1, 6>;

constexpr double same_motion = 1e-8;  // of unit motions; the mesh's coordinates have 12 digits
/// Of the sum of the absolute values of the terms of r^T K r, whose round-off is 1e-15 of it.
constexpr double no_force = 1e-13;

/// Disjoint sets of active numbers that elements and couplings connect.
class Connection {
 public:
  explicit Connection(int n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i)
  {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int i, int j) { parent_[root(i)] = root(j); }

 private:
  std::vector<int> parent_;
};

/// The part of each active number, and how many there are.
struct Parts {
  std::vector<int> of_number;
  int count = 0;
};

Parts connected_parts(const mesh::Mesh& mesh, const DofMap& dofs)
{
  Connection connection(dofs.n_active());
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      const int first = dofs.motion(block.element_nodes(e)[0]).front().number;
      for (const int node : block.element_nodes(e)) {
        for (const MotionTerm& term : dofs.motion(node)) connection.join(first, term.number);
      }
    }
  }
  Parts parts{.of_number = std::vector<int>(dofs.n_active(), -1)};
  std::vector<int> of_root(dofs.n_active(), -1);
  for (int i = 0; i < dofs.n_active(); ++i) {
    int& part = of_root[connection.root(i)];
    if (part < 0) part = parts.count++;
    parts.of_number[i] = part;
  }
  return parts;
}

/// Centre and mean radius of each part, the geometry that scales rotations.
struct Extent {
  Vector3d centre = Vector3d::Zero();
  double length = 0.0;
  int n_nodes = 0;
};

std::vector<Extent> extents(const DofMap& dofs, const Parts& parts)
{
  std::vector<Extent> extents(parts.count);
  const auto for_nodes = [&](const auto& visit) {
    for (int node = 0; node < dofs.n_nodes(); ++node) {
      const auto dof = dofs.dof(node, 0);
      if (!dof) continue;
      const auto& x = dofs.positions[node];
      visit(extents[parts.of_number[*dof / 6]], Vector3d(x[0], x[1], x[2]));
    }
  };
  for_nodes([](Extent& extent, const Vector3d& x) {
    extent.centre += x;
    ++extent.n_nodes;
  });
  for (Extent& extent : extents) extent.centre /= std::max(extent.n_nodes, 1);
  for_nodes([](Extent& extent, const Vector3d& x) {
    extent.length += (x - extent.centre).norm() / extent.n_nodes;
  });
  for (Extent& extent : extents) {
    if (!(extent.length > 0.0)) extent.length = 1.0;  // a single node
  }
  return extents;
}

/// What one unit of each rigid motion is at this component of a node.
RowVector6d rigid_row(const std::array<double, 3>& position, const Extent& extent, int component)
{
  const Vector3d r =
      (Vector3d(position[0], position[1], position[2]) - extent.centre) / extent.length;
  RowVector6d row = RowVector6d::Zero();
  if (component >= 3) {
    row[component] = 1.0;  // times 1 / length
    return row;
  }
  row[component] = 1.0;
  for (int axis = 0; axis < 3; ++axis) row[3 + axis] = Vector3d::Unit(axis).cross(r)[component];
  return row;
}

/// For each part the rigid motions that are zero at all its held DOFs, [6 x n].
std::vector<MatrixXd> motions_not_held(const DofMap& dofs, const Parts& parts,
                                       const std::vector<Extent>& extents,
                                       const std::vector<int>& held)
{
  std::vector<MatrixXd> gram(parts.count, MatrixXd::Zero(6, 6));
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    for (int component = 0; component < 6; ++component) {
      const auto dof = dofs.dof(node, component);
      if (!dof || !std::ranges::binary_search(held, *dof)) continue;
      const int part = parts.of_number[*dof / 6];
      const RowVector6d row = rigid_row(dofs.positions[node], extents[part], component);
      gram[part] += row.transpose() * row;
    }
  }
  std::vector<MatrixXd> motions;
  for (const MatrixXd& G : gram) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(G);
    Index n = 0;
    while (n < 6 && eigen.eigenvalues()[n] < same_motion * same_motion * std::max(1.0, G.trace())) {
      ++n;
    }
    motions.emplace_back(eigen.eigenvectors().leftCols(n));
  }
  return motions;
}

/// One rigid motion of one part at every DOF.
petsc::Vector spread(const System& system, const Parts& parts, int part, const Extent& extent,
                     const Eigen::VectorXd& motion)
{
  petsc::Vector r;
  petsc::check(MatCreateVecs(system.K, r.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(r, &first, &last));
  for (int node = 0; node < system.dofs.n_nodes(); ++node) {
    for (int component = 0; component < 6; ++component) {
      const auto dof = system.dofs.dof(node, component);
      if (!dof || *dof < first || *dof >= last || parts.of_number[*dof / 6] != part) continue;
      const double scale = component < 3 ? 1.0 : 1.0 / extent.length;
      const double value =
          scale * rigid_row(system.dofs.positions[node], extent, component).dot(motion.transpose());
      petsc::check(VecSetValue(r, *dof, value, INSERT_VALUES));
    }
  }
  petsc::check(VecAssemblyBegin(r));
  petsc::check(VecAssemblyEnd(r));
  return r;
}

/// The size of the terms that cancel in r^T K r: sum over the rows of max_j |K_ij| r_i^2.
double size_of_terms(Mat K, Vec r)
{
  petsc::Vector r_abs, product;
  petsc::check(VecDuplicate(r, r_abs.put()));
  petsc::check(VecCopy(r, r_abs));
  petsc::check(VecAbs(r_abs));
  petsc::check(VecDuplicate(r, product.put()));
  petsc::check(MatGetRowMaxAbs(K, product, nullptr));
  petsc::check(VecPointwiseMult(product, product, r_abs));
  double size = 0.0;
  petsc::check(VecDot(product, r_abs, &size));
  return size;
}

bool is_without_force(Mat K, Vec r)
{
  petsc::Vector K_r;
  petsc::check(VecDuplicate(r, K_r.put()));
  petsc::check(MatMult(K, r, K_r));
  double energy = 0.0;
  petsc::check(VecDot(r, K_r, &energy));
  return std::abs(energy) <= no_force * size_of_terms(K, r);
}

}  // namespace

std::vector<FreePart> free_parts(const mesh::Mesh& mesh, const System& system,
                                 const std::vector<int>& held)
{
  const Parts parts = connected_parts(mesh, system.dofs);
  const std::vector<Extent> extent = extents(system.dofs, parts);
  const std::vector<MatrixXd> motions = motions_not_held(system.dofs, parts, extent, held);
  std::vector<FreePart> free;
  for (int part = 0; part < parts.count; ++part) {
    FreePart found{
        .n_nodes = extent[part].n_nodes, .centre = extent[part].centre, .motions = MatrixXd(6, 0)};
    for (Index k = 0; k < motions[part].cols(); ++k) {
      const petsc::Vector r = spread(system, parts, part, extent[part], motions[part].col(k));
      if (!is_without_force(system.K, r)) continue;
      found.motions.conservativeResize(6, found.motions.cols() + 1);
      found.motions.rightCols<1>() = motions[part].col(k);
    }
    if (found.motions.cols() > 0) free.push_back(std::move(found));
  }
  return free;
}

int n_free_motions(const std::vector<FreePart>& parts)
{
  int n = 0;
  for (const FreePart& part : parts) n += static_cast<int>(part.motions.cols());
  return n;
}

std::string describe_motions(const FreePart& part)
{
  constexpr std::array names{"translation along x", "translation along y", "translation along z",
                             "rotation about x",    "rotation about y",    "rotation about z"};
  std::vector<std::string> pure;
  for (Index c = 0; c < 6; ++c) {
    // A unit motion of its own if all of it lies in the space of the free ones.
    if (part.motions.row(c).norm() > 1.0 - same_motion) {
      pure.emplace_back(names[static_cast<std::size_t>(c)]);
    }
  }
  const auto n = part.motions.cols();
  return fmt::format("{} way{}{}", n, n == 1 ? "" : "s",
                     pure.empty() ? "" : fmt::format(" ({})", fmt::join(pure, ", ")));
}

void check_stiffness_of_all_nodes(const mesh::Mesh& mesh, const DofMap& dofs)
{
  std::vector<bool> touched(dofs.n_active(), false);
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (const int node : block.nodes) {
      for (const MotionTerm& term : dofs.motion(node)) touched[term.number] = true;
    }
  }
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    const auto dof = dofs.dof(node, 0);
    if (!dof || touched[*dof / 6]) continue;
    if (node >= dofs.n_mesh_nodes) {
      throw Error(fmt::format("coupling \"{}\": none of its nodes belongs to an element",
                              dofs.reference_names[node - dofs.n_mesh_nodes]));
    }
    throw Error(
        fmt::format("node {} belongs to no element, so nothing gives it stiffness; take it out of "
                    "the mesh or let it follow a coupling",
                    mesh.node_numbers[node]));
  }
}

}  // namespace chladni::plate
