#pragma once

#include <Eigen/Geometry>

#include <array>
#include <numbers>
#include <optional>
#include <vector>

/// Bodies of equal sectors about the z axis, one of which has been assembled.

namespace chladni::cyclic {

/// Nodes at equal angles on a circle of the whole body, whose harmonics are coordinates.
struct Ring {
  std::vector<int> blocks;     ///< of its nodes in this sector, including both cut edges
  std::vector<double> angles;  ///< of these nodes, rad
  int n_nodes;                 ///< number in the whole ring: a multiple of the number of sectors
  double first_angle;          ///< of the node with the least angle in [0, 2 pi), rad
  int up_to;                   ///< highest harmonic that is a master
};

/// A plane through the axis to which the sector is symmetric.
struct Mirror {
  double angle;            ///< of the plane, rad
  std::vector<int> image;  ///< [n_blocks] the block at each block's mirrored place
};

/// The DOFs of the assembled sector: a block of `components` for each node that has DOFs.
struct SectorDofs {
  int count;  ///< number of sectors, at least 3
  int n_blocks;
  std::vector<int> components;  ///< ascending, of u_x, u_y, u_z, theta_x, theta_y, theta_z
  std::vector<std::array<int, 2>> edges;  ///< blocks of the cut edges: a turn takes [0] to [1]
  std::vector<int> axis;                  ///< blocks of nodes on the axis; all are masters
  std::vector<Ring> rings;
  std::optional<Mirror> mirror = {};  ///< `find_mirror`
  /// [n_blocks] Whether a block holds rotations: in a model with solids `components` are 0 to 2,
  /// and a node with rotations has a second block for these. Empty: no block does.
  std::vector<char> rotating = {};
  std::vector<int> axis_rotations = {};  ///< these of nodes on the axis, -1: none; empty: all none

  int n_dofs() const { return n_blocks * static_cast<int>(components.size()); }
  bool is_rotating(int block) const
  {
    return !rotating.empty() && rotating[static_cast<std::size_t>(block)] != 0;
  }
  /// The component (0 to 5) at a place of a block.
  int component(int block, int place) const
  {
    return components[static_cast<std::size_t>(place)] + (is_rotating(block) ? 3 : 0);
  }
};

/// The number of harmonics 0 .. floor(count / 2). From a sector to the next the motion is
/// multiplied by exp(i mu), mu = 2 pi order / count.
constexpr int n_harmonics(int count)
{
  return count / 2 + 1;
}

/// True if mu is 0 or pi: the motion has one phase. All other harmonics have two.
constexpr bool has_one_phase(int order, int count)
{
  return order == 0 || 2 * order == count;
}

/// The rotation matrix about the z axis by an angle in rad; for positions, displacements and
/// rotations.
inline Eigen::Matrix3d turn(double angle)
{
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// The rotation from the first sector to sector `sector`.
inline Eigen::Matrix3d turn_of_sector(int sector, int count)
{
  return turn(2.0 * std::numbers::pi * sector / count);
}

}  // namespace chladni::cyclic
