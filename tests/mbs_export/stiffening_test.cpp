#include "mbs_export/inertia.hpp"

#include <gtest/gtest.h>

#include "common/error.hpp"
#include "expect_equal.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mbs_export/make_body.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::MatrixXd, Eigen::Vector3d;

/// All twelve matrices, none like another.
Stiffening all_loads(Eigen::Index n)
{
  Stiffening stiffening{.fixed = {}, .loads = {}, .K = {}};
  for (const std::string& load : stiffening_loads) {
    stiffening.loads.push_back(load);
    const double i = double(stiffening.loads.size());
    stiffening.K.push_back(MatrixXd::Identity(n, n) * i + MatrixXd::Constant(n, n, 1.0 / i));
  }
  return stiffening;
}

TEST(SpinStiffening, IsTheFormOfTheAxisInTheProductsOfItsComponents)
{
  const Stiffening all = all_loads(2);
  const Vector3d e(0.48, 0.6, 0.64);
  MatrixXd expected =
      e.x() * e.x() * all.K[0] + e.y() * e.y() * all.K[1] + e.z() * e.z() * all.K[2];
  expected += e.x() * e.y() * all.K[3] + e.y() * e.z() * all.K[4] + e.z() * e.x() * all.K[5];
  EXPECT_LT((spin_stiffening(all, e) - expected).norm(), 1e-15 * expected.norm());  // round-off
}

TEST(SpinStiffening, NeedsTheLoadsOfItsAxisAlone)
{
  Stiffening about_z = all_loads(2);
  about_z.loads = {"omega_zz"};
  about_z.K = {about_z.K[2]};
  EXPECT_EQ(spin_stiffening(about_z, Vector3d::UnitZ()), about_z.K[0]);
  try {
    spin_stiffening(about_z, Vector3d(0.6, 0.0, 0.8));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("load omega_xx; there are those of: omega_zz"),
              std::string::npos)
        << error.what();
  }
}

TEST(Stiffening, GoesWithTheModesOfABodyThatIsHeldAlike)
{
  ReducedSystem wheel = test::wheel();
  wheel.stiffening = all_loads(wheel.K.rows());
  const ModalBody body = make_body(wheel, {});
  ASSERT_TRUE(body.stiffening);
  EXPECT_EQ(body.stiffening->loads, wheel.stiffening->loads);
  // All DOFs are masters, of which the modes at the nodes are the transformation.
  const MatrixXd& T = body.attachment_modes;
  const MatrixXd expected = T.transpose() * wheel.stiffening->K[4] * T;
  EXPECT_LT((body.stiffening->K[4] - expected).norm(), 1e-12 * expected.norm());
  wheel.stiffening->fixed = {"hub"};
  EXPECT_FALSE(make_body(wheel, {}).stiffening);
  BodyOptions on_hub;
  on_hub.fixed = {"hub"};
  EXPECT_TRUE(make_body(wheel, on_hub).stiffening);
  wheel.stiffening->fixed = {"hub", "rim.z"};
  on_hub.fixed = {"rim.z", "hub.rx", "hub.ry", "hub.rz", "hub.x", "hub.y", "hub.z"};
  EXPECT_TRUE(make_body(wheel, on_hub).stiffening);
}

TEST(Stiffening, IsReadAsItWasWritten)
{
  const files::test::ScratchFolder folder;
  ReducedSystem wheel = test::wheel();
  wheel.stiffening = all_loads(wheel.K.rows());
  wheel.stiffening->fixed = {"hub.z", "rim.x"};
  write_reduced(folder.file("a.h5"), wheel);
  test::expect_equal(read_reduced(folder.file("a.h5")), wheel);
  wheel.stiffening->fixed.clear();
  const ModalBody body = make_body(wheel, {});
  write_body(folder.file("b.h5"), body);
  test::expect_equal(read_body(folder.file("b.h5")), body);
}

TEST(Stiffening, IsRefusedWithALoadThatNobodyKnowsOrOutOfOrder)
{
  const files::test::ScratchFolder folder;
  ReducedSystem wheel = test::wheel();
  const auto refused = [&](const std::vector<std::string>& loads) {
    wheel.stiffening = all_loads(wheel.K.rows());
    wheel.stiffening->loads = loads;
    write_reduced(folder.file("a.h5"), wheel);
    return files::test::error_of([&] { read_reduced(folder.file("a.h5")); });
  };
  EXPECT_NE(refused({"omega_xx", "heat"}).find("\"heat\""), std::string::npos);
  EXPECT_NE(refused({"omega_yy", "omega_xx"}).find("stiffening/loads"), std::string::npos);
}

}  // namespace
}  // namespace chladni::mbs_export
