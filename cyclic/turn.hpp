#pragma once

#include <Eigen/Geometry>
#include <numbers>

namespace chladni::cyclic {

/// The turn about the z axis by an angle in rad: of positions, and of displacements and rotations
/// alike.
inline Eigen::Matrix3d turn(double angle)
{
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// From the first sector to a later one.
inline Eigen::Matrix3d turn_of_sector(int sector, int count)
{
  return turn(2.0 * std::numbers::pi * sector / count);
}

}  // namespace chladni::cyclic
