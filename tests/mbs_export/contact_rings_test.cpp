#include "mbs_export/modal_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

/// Nodal displacements and rotations of the surface u_z = f(x, y) under thin-plate kinematics,
/// theta_x = df/dy, theta_y = -df/dx, with f = x + 2 y + 3 x y.
MatrixXd plate_motion(const ReducedSystem& system)
{
  MatrixXd motion = MatrixXd::Zero(6 * Eigen::Index(system.attachment_nodes.size()), 1);
  for (Eigen::Index i = 0; 6 * i < motion.rows(); ++i) {
    const auto& X = system.attachment_nodes[static_cast<std::size_t>(i)].position;
    motion(6 * i + 2) = X.x() + 2 * X.y() + 3 * X.x() * X.y();
    motion(6 * i + 3) = 2 + 3 * X.x();
    motion(6 * i + 4) = -(1 + 3 * X.y());
  }
  return motion;
}

TEST(ContactRing, HasTheSlopesOfTheSurface)
{
  const ReducedSystem wheel = test::wheel();
  const auto rings = contact_rings(wheel, plate_motion(wheel));
  ASSERT_EQ(rings.size(), 1u);
  const ContactRing& ring = rings[0];
  EXPECT_EQ(ring.name, "rim");
  EXPECT_NEAR(ring.radius, test::wheel_radius, 1e-15);
  EXPECT_EQ(ring.height, test::wheel_height);
  for (int i = 0; i < test::wheel_rim_nodes; ++i) {
    const double phi = ring.angles[i], c = std::cos(phi), s = std::sin(phi), r = ring.radius;
    EXPECT_NEAR(phi, 2 * std::numbers::pi * i / test::wheel_rim_nodes, 1e-14);
    // f(r, phi) = r c + 2 r s + 3 r^2 c s: df/dr and (1/r) df/dphi
    EXPECT_NEAR(ring.W(i, 0), r * c + 2 * r * s + 3 * r * r * c * s, 1e-15);
    EXPECT_NEAR(ring.W_r(i, 0), c + 2 * s + 6 * r * c * s, 1e-14);
    EXPECT_NEAR(ring.W_t(i, 0), -s + 2 * c + 3 * r * (c * c - s * s), 1e-14);
  }
}

TEST(ContactRing, IsOrderedByAngleWhateverTheOrderOfTheSet)
{
  ReducedSystem wheel = test::wheel();
  std::swap(wheel.sets[0].nodes[0], wheel.sets[0].nodes[7]);
  const auto rings = contact_rings(wheel, plate_motion(wheel));
  ASSERT_EQ(rings.size(), 1u);
  EXPECT_EQ(rings[0].nodes[7], 7);
  EXPECT_EQ(rings[0].nodes[0], 0);
}

TEST(ContactRing, NeedsEqualAnglesOneCircleAndTheDofAlongTheAxis)
{
  const auto n_rings = [](const ReducedSystem& system) {
    return contact_rings(system, plate_motion(system)).size();
  };
  ReducedSystem gap = test::wheel();
  gap.sets[0].nodes.pop_back();
  EXPECT_EQ(n_rings(gap), 0u);
  ReducedSystem dent = test::wheel();
  dent.attachment_nodes[3].position *= 1.001;
  EXPECT_EQ(n_rings(dent), 0u);
  ReducedSystem tilted = test::wheel();
  tilted.attachment_nodes[3].position.z() += 1e-4;
  EXPECT_EQ(n_rings(tilted), 0u);
  ReducedSystem flat = test::wheel();
  std::erase_if(flat.masters, [](const MasterDof& dof) { return dof.component == 2; });
  EXPECT_EQ(n_rings(flat), 0u);
}

TEST(ContactRing, HasNoSlopesWhereItsNodesDoNotRotate)
{
  ReducedSystem translations = test::wheel();
  std::erase_if(translations.masters, [](const MasterDof& dof) { return dof.component == 3; });
  const std::vector<ContactRing> rings = contact_rings(translations, plate_motion(translations));
  ASSERT_EQ(rings.size(), 1u);
  EXPECT_GT(rings[0].W.norm(), 0.0);
  EXPECT_EQ(rings[0].W_r.norm() + rings[0].W_t.norm(), 0.0);
}

TEST(FourierCoefficients, RecoverHarmonicsAndReproduceTheNodes)
{
  for (const int N : {7, 8}) {
    const VectorXd angles = VectorXd::LinSpaced(N, 0.3, 0.3 + 2 * std::numbers::pi * (N - 1) / N);
    const MatrixXd values = (2.0 + 3.0 * (2.0 * angles.array()).cos() - (angles.array()).sin() +
                             0.5 * (double(N / 2) * (angles.array() - 0.3)).cos())
                                .matrix();
    const auto [cosine, sine] = fourier_coefficients(angles, values);
    EXPECT_NEAR(cosine(0, 0), 2.0, 1e-14);
    EXPECT_NEAR(cosine(2, 0), 3.0, 1e-14);
    EXPECT_NEAR(sine(1, 0), -1.0, 1e-14);
    for (int i = 0; i < N; ++i) {
      double sum = 0.0;
      for (int n = 0; n < cosine.rows(); ++n)
        sum += cosine(n, 0) * std::cos(n * angles[i]) + sine(n, 0) * std::sin(n * angles[i]);
      EXPECT_NEAR(sum, values(i, 0), 1e-13);
    }
  }
}

}  // namespace
}  // namespace chladni::mbs_export
