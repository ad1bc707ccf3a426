// Systems whose masters are harmonics of a ring.
#include <gtest/gtest.h>

#include <cmath>

#include "expect_equal.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/check_body.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mbs_export/formats/formats.hpp"
#include "mbs_export/free_modes.hpp"
#include "mbs_export/make_body.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd;
using files::test::error_of;

constexpr Index n_rim = test::wheel_rim_nodes;

/// F of the rim, then the hub as it is: harmonic k of component c is column 6 k + c.
MatrixXd harmonics_of_the_rim()
{
  MatrixXd F = MatrixXd::Identity(6 * (n_rim + 1), 6 * (n_rim + 1));
  F.topLeftCorner(6 * n_rim, 6 * n_rim).setZero();
  for (Index k = 0; k < n_rim; ++k) {
    const auto n = static_cast<double>((k + 1) / 2);
    const double length = k == 0 || k == n_rim - 1 ? std::sqrt(n_rim) : std::sqrt(0.5 * n_rim);
    for (Index i = 0; i < n_rim; ++i) {
      const double phi = 2.0 * M_PI * double(i) / double(n_rim);
      const double value = (k > 0 && k % 2 == 0 ? std::sin(n * phi) : std::cos(n * phi)) / length;
      Eigen::Matrix3d E;
      E << std::cos(phi), -std::sin(phi), 0, std::sin(phi), std::cos(phi), 0, 0, 0, 1;
      F.block<3, 3>(6 * i, 6 * k) = F.block<3, 3>(6 * i + 3, 6 * k + 3) = value * E;
    }
  }
  return F;
}

/// The wheel with the harmonics up to `up_to` as masters. The others are neither masters nor modes:
/// the rim does not move that way.
ReducedSystem harmonic_wheel(Index up_to)
{
  ReducedSystem system = test::wheel();
  const Index n_kept = std::min(2 * up_to + 1, n_rim);
  const MatrixXd F_all = harmonics_of_the_rim();
  MatrixXd F(F_all.rows(), 6 * n_kept + 6);
  F << F_all.leftCols(6 * n_kept), F_all.rightCols(6);
  system.masters.clear();
  for (int k = 0; k < n_kept; ++k)
    for (int c = 0; c < 6; ++c) {
      system.masters.push_back(
          {-1, c, RingHarmonic{.set = 0, .order = (k + 1) / 2, .is_sine = k > 0 && k % 2 == 0}});
    }
  for (int c = 0; c < 6; ++c) system.masters.push_back({int(n_rim), c});
  system.K = F.transpose() * system.K * F;
  system.M = F.transpose() * system.M * F;
  system.mass_integrals = in_coordinates(*system.mass_integrals, F);
  system.ring_motion = RingMotion{.shapes = F, .displacements = F};
  return system;
}

TEST(RingMotion, OfAllHarmonicsIsTheWheel)
{
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.count = 10;
  options.interface_modes = {
      {.kind = InterfaceModes::Kind::irm, .at = "rim", .components = {2}, .omega0 = {}}};
  const ModalBody plain = make_body(test::wheel(), options);
  const ModalBody body = make_body(harmonic_wheel(6), options);
  ASSERT_EQ(body.n_modes(), plain.n_modes());
  // Another basis of the same space: round-off of a condition of some 1e3.
  EXPECT_TRUE(body.omega.isApprox(plain.omega, 1e-9));
  ASSERT_EQ(body.rings.size(), 1u);
  const MatrixXd flexibility = plain.rings[0].W *
                               plain.omega.cwiseAbs2().cwiseInverse().asDiagonal() *
                               plain.rings[0].W.transpose();
  EXPECT_TRUE((body.rings[0].W * body.omega.cwiseAbs2().cwiseInverse().asDiagonal() *
               body.rings[0].W.transpose())
                  .isApprox(flexibility, 1e-8));
  for (const Check& check : check_body(body)) EXPECT_EQ(check.verdict, Verdict::pass) << check.name;
}

TEST(RingMotion, KeepsRigidBodyMotionsWithTheFirstHarmonic)
{
  const ReducedSystem wheel = harmonic_wheel(1);
  for (const Check& check : check_reduced(wheel))
    EXPECT_EQ(check.verdict, Verdict::pass) << check.name << check.value;
  EXPECT_EQ(orthogonalize(wheel).n_rigid, 6);
  const RigidInertia exact = rigid_inertia(test::wheel()), found = rigid_inertia(wheel);
  EXPECT_NEAR(found.mass, exact.mass, 1e-12);
  EXPECT_TRUE(found.inertia.isApprox(exact.inertia, 1e-12));
}

TEST(RingMotion, IsZeroAtANodeThatIsHeld)
{
  ReducedSystem wheel = harmonic_wheel(3);
  wheel.sets.push_back({"stop", {2}});
  BodyOptions options;
  options.fixed = {"hub", "stop.z", "stop.x"};
  const ModalBody body = make_body(wheel, options);
  const double scale = body.attachment_modes.cwiseAbs().maxCoeff();
  EXPECT_LT(body.attachment_modes.row(6 * 2 + 2).cwiseAbs().maxCoeff(), 1e-9 * scale);
  EXPECT_LT(body.attachment_modes.row(6 * 2 + 0).cwiseAbs().maxCoeff(), 1e-9 * scale);
  EXPECT_GT(body.attachment_modes.row(6 * 3 + 2).cwiseAbs().maxCoeff(), 1e-3 * scale);
  for (const Check& check : check_body(body)) EXPECT_EQ(check.verdict, Verdict::pass) << check.name;
  // Seven amplitudes cannot hold twelve nodes.
  options.fixed = {"rim.z"};
  EXPECT_NE(error_of([&] { make_body(wheel, options); }).find("cannot hold rim.z (node"),
            std::string::npos);
}

TEST(RingMotion, IsReadAsItWasWritten)
{
  const files::test::ScratchFolder folder;
  const ReducedSystem wheel = harmonic_wheel(2);
  write_reduced(folder.file("a.reduced.h5"), wheel);
  test::expect_equal(read_reduced(folder.file("a.reduced.h5")), wheel);
}

TEST(RingMotion, IsRefusedWhenItMakesNoSense)
{
  const files::test::ScratchFolder folder;
  const auto error_after = [&](const auto& damage) {
    ReducedSystem wheel = harmonic_wheel(2);
    damage(wheel);
    write_reduced(folder.file("bad.h5"), wheel);
    return error_of([&] { read_reduced(folder.file("bad.h5")); });
  };
  const auto expect_mention = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' lacks '" << part << "'";
  };
  using System = ReducedSystem;
  expect_mention(error_after([](System& s) { s.masters[7] = s.masters[6]; }), "twice");
  expect_mention(error_after([](System& s) { s.masters[7].harmonic->set = 2; }),
                 "masters/ring: has the index 2, expected 0 .. 1");
  expect_mention(error_after([](System& s) { s.masters[7].harmonic->order = -1; }),
                 "masters/harmonic");
  expect_mention(error_after([](System& s) { s.masters[7].node = 3; }), "masters/node: has 3");
  expect_mention(error_after([](System& s) { s.masters.back().node = -1; }), "masters/node");
  expect_mention(error_after([](System& s) { s.ring_motion->shapes *= 2.0; }),
                 "masters/shapes: has columns that are not orthonormal");
  expect_mention(error_after([](System& s) { s.ring_motion->shapes.conservativeResize(78, 5); }),
                 "masters/shapes: has shape");
  expect_mention(error_after([](System& s) { s.ring_motion->displacements.resize(77, 36); }),
                 "attachment/displacements: has shape");
}

TEST(RingMotion, IsNoMatterForNastran)
{
  EXPECT_NE(error_of([] { formats::nastran_dmig(harmonic_wheel(2)); }).find("interface.rings"),
            std::string::npos);
}

}  // namespace
}  // namespace chladni::mbs_export
