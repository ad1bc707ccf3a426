#include "squeal/assembly/part_components.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/attachment_motion.hpp"

namespace chladni::squeal {
namespace {

using mbs_export::component_name;

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

}  // namespace chladni::squeal
