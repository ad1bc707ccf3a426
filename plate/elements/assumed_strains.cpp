#include "plate/elements/assumed_strains.hpp"

#include <Eigen/Dense>
#include <vector>

namespace chladni::plate {

namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Components (11, 22, 12) of A^T eps A from those of the symmetric tensor eps.
Matrix3d congruence(const Matrix2d& A)
{
  Matrix3d T;
  T << A(0, 0) * A(0, 0), A(1, 0) * A(1, 0), 2.0 * A(0, 0) * A(1, 0),  //
      A(0, 1) * A(0, 1), A(1, 1) * A(1, 1), 2.0 * A(0, 1) * A(1, 1),   //
      A(0, 0) * A(0, 1), A(1, 0) * A(1, 1), A(0, 0) * A(1, 1) + A(1, 0) * A(0, 1);
  return T;
}

/// At each point F_ia = t_i . a_a for an orthonormal tangent frame (t_1, t_2) that follows one
/// direction through the element, and the area element.
struct TangentFrames {
  std::vector<Matrix2d> F;
  Eigen::VectorXd J;
};

TangentFrames tangent_frames(const ShellFrame& frame, const Eigen::VectorXd& weight)
{
  const Eigen::Index n = frame.a_1.rows();
  TangentFrames frames{.F = std::vector<Matrix2d>(n), .J = Eigen::VectorXd(n)};
  std::vector<Vector3d> normal(n);
  Vector3d mean_normal = Vector3d::Zero();
  for (Eigen::Index q = 0; q < n; ++q) {
    const Vector3d area = frame.a_1.row(q).cross(frame.a_2.row(q));
    frames.J[q] = area.norm();
    normal[q] = area / frames.J[q];
    mean_normal += weight[q] * area;
  }
  mean_normal.normalize();
  const Vector3d a_1 = frame.a_1.row(n / 2);
  const Vector3d direction = a_1 - a_1.dot(mean_normal) * mean_normal;
  for (Eigen::Index q = 0; q < n; ++q) {
    const Vector3d t_1 = (direction - direction.dot(normal[q]) * normal[q]).normalized();
    const Vector3d t_2 = normal[q].cross(t_1);
    frames.F[q] << frame.a_1.row(q).dot(t_1), frame.a_2.row(q).dot(t_1), frame.a_1.row(q).dot(t_2),
        frame.a_2.row(q).dot(t_2);
  }
  return frames;
}

}  // namespace

std::array<StrainRows, 3> correct_mean(const std::array<StrainRows, 3>& tied,
                                       const std::array<StrainRows, 3>& compatible,
                                       const ShellFrame& frame, const Eigen::VectorXd& weight)
{
  const TangentFrames frames = tangent_frames(frame, weight);
  const Eigen::Index n_points = tied[0].rows();
  StrainRows mean = StrainRows::Zero(3, tied[0].cols());
  StrainRows difference(3, tied[0].cols());
  for (Eigen::Index q = 0; q < n_points; ++q) {
    for (int r = 0; r < 3; ++r) difference.row(r) = compatible[r].row(q) - tied[r].row(q);
    mean.noalias() += weight[q] * frames.J[q] * congruence(frames.F[q].inverse()) * difference;
  }
  mean /= weight.dot(frames.J);
  std::array<StrainRows, 3> corrected = tied;
  for (Eigen::Index q = 0; q < n_points; ++q) {
    const StrainRows constant = congruence(frames.F[q]) * mean;
    for (int r = 0; r < 3; ++r) corrected[r].row(q) += constant.row(r);
  }
  return corrected;
}

}  // namespace chladni::plate
