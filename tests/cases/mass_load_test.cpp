#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "cases/moving_body.hpp"
#include "mbs_export/inertia.hpp"

namespace chladni::cases {
namespace {

using Eigen::Vector3d;

/// The force on a unit mass at x.
Vector3d force_at(const Eigen::Vector<double, 12>& load, const Vector3d& x)
{
  Vector3d force = load.head<3>();
  for (int k = 0; k < 3; ++k) force += x[k] * load.segment<3>(3 + 3 * k);
  return force;
}

TEST(MassLoad, OfAllMotionsTogetherIsTheInertialForceOfAMovingFrame)
{
  const Vector3d omega(0.7, -1.1, 0.4), alpha(2.0, 0.3, -0.6), a(5.0, -9.0, 1.0);
  std::vector<double> factors;
  for (const auto& [k, l] : mbs_export::product_axes) factors.push_back(omega[k] * omega[l]);
  for (const Vector3d& rate : {alpha, a}) factors.insert(factors.end(), rate.begin(), rate.end());
  Eigen::Vector<double, 12> load = Eigen::Vector<double, 12>::Zero();
  for (std::size_t i = 0; i < factors.size(); ++i)
    load += factors[i] * mass_load(mbs_export::stiffening_loads[i]);
  for (const Vector3d& x : {Vector3d(1, 0, 0), Vector3d(0.3, -2.0, 0.9)}) {
    const Vector3d expected = -(omega.cross(omega.cross(x)) + alpha.cross(x) + a);
    EXPECT_LT((force_at(load, x) - expected).norm(), 1e-14 * expected.norm());
  }
}

TEST(InertialLoad, IsThatOfARigidBodyAboutItsCentre)
{
  const Vector3d a(5.0, -9.0, 1.0), alpha(2.0, 0.3, -0.6), centre(0.4, 1.7, -0.2);
  Eigen::Vector<double, 6> acceleration;
  acceleration << a, alpha;
  const Eigen::Vector<double, 12> load = inertial_load(acceleration, centre);
  for (const Vector3d& x : {Vector3d(1, 0, 0), Vector3d(0.3, -2.0, 0.9)}) {
    const Vector3d expected = -(a + alpha.cross(x - centre));
    EXPECT_LT((force_at(load, x) - expected).norm(), 1e-14 * expected.norm());
  }
}

}  // namespace
}  // namespace chladni::cases
