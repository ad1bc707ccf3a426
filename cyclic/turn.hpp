#pragma once

#include <Eigen/Geometry>
#include <numbers>

namespace chladni::cyclic {

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
