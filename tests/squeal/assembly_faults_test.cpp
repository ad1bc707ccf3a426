// What an assembly refuses, and what it says of its joints.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "assembly_parts.hpp"
#include "common/error.hpp"
#include "squeal/assembly/assembly.hpp"
#include "squeal/assembly/joints.hpp"
#include "squeal/friction.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

/// Without what a body does not have: row `component` of all nodes is zero.
mbs_export::ModalBody without(mbs_export::ModalBody body, int component)
{
  for (Eigen::Index i = 0; i < std::ssize(body.attachment_nodes); ++i)
    body.attachment_modes.row(6 * i + component).setZero();
  return body;
}

TEST(Assembly, RefusesFacesAndJointsOfBodiesThatLackAComponent)
{
  std::vector<mbs_export::ModalBody> bodies = bodies_of_two_plates();
  bodies[2] = without(bodies[2], 4);
  // The joint asks for ry of its node.
  EXPECT_NE(error_of(two_plates(), bodies)
                .find("joint[2].between: the modes of \"lower.centre\" (lower.body.h5) have no "
                      "component ry there"),
            std::string::npos)
      << error_of(two_plates(), bodies);
  AssemblyOptions options = two_plates();
  options.joints[1].stiffness[4] = options.joints[1].damping[4] = 0.0;
  EXPECT_NE(error_of(options, bodies)
                .find("contact[2].face: the modes of \"lower.face\" (lower.body.h5) have no "
                      "component ry there"),
            std::string::npos)
      << error_of(options, bodies);
  bodies[2] = without(bodies_of_two_plates()[2], 0);
  options.joints[1].stiffness[0] = options.joints[1].damping[0] = 0.0;
  EXPECT_NE(error_of(options, bodies).find("have no component x there"), std::string::npos)
      << error_of(options, bodies);
  // About z neither turns its face, and no joint of this one.
  bodies[2] = without(bodies_of_two_plates()[2], 5);
  options.joints[1] = suspension_of("lower");
  options.joints[1].stiffness[5] = options.joints[1].damping[5] = 0.0;
  EXPECT_EQ(error_of(options, bodies).find("have no component"), std::string::npos)
      << error_of(options, bodies);
}

TEST(Joints, NeedRotationsToReachOverTheirSpan)
{
  const auto body = without(plate_body(plate, {}), 4);
  const std::vector<Part> parts{placed(part_at("upper", 0.02), body),
                                placed(part_at("lower", 0.0), body)};
  JointOptions joint{.ends = {PartNodes{"upper", "centre"}, PartNodes{"lower", "centre"}},
                     .rigid = {},
                     .span = 0.03};
  joint.stiffness = {0.0, 1e6, 1e6, 0.0, 0.0, 0.0};
  EXPECT_NO_THROW(joined(parts, std::vector{joint}));
  // Over a span along z, x follows the rotation about y.
  joint.stiffness[0] = 1e6;
  EXPECT_THROW(joined(parts, std::vector{joint}), Error);
}

TEST(Joints, LeaveTheRotationAboutTheNormalOfAShellAlone)
{
  auto shell = plate_body(plate, {});
  shell.attachment_nodes[0].drilling_axis = Eigen::Vector3d::UnitZ();
  // Turned by a quarter about x, its normal is -y of the brake.
  const std::vector<Part> parts{placed(part_at("upper", 0.0, 0.5 * pi), shell),
                                placed(part_at("lower", 0.0), plate_body(plate, {}))};
  JointOptions joint{.ends = {PartNodes{"upper", "centre"}, PartNodes{"lower", "centre"}},
                     .rigid = {0, 1, 2, 3, 4, 5},
                     .spares_drilling = true};
  const Eigen::MatrixXd B = joined(parts, std::vector{joint}).B;
  ASSERT_EQ(B.rows(), 5);
  // It turns about the normal, and about no other axis of its own.
  EXPECT_LT(B.col(5).norm(), 1e-9);
  for (const int axis : {3, 4}) EXPECT_GT(B.col(axis).norm(), 1.0);
  const auto error = [&] {
    try {
      joined(parts, std::vector{joint});
    } catch (const Error& refused) {
      return std::string(refused.what());
    }
    return std::string();
  };
  joint.spares_drilling = false;
  EXPECT_NE(error().find("joint[1].between: ry of \"upper.centre\" (upper.body.h5) turns nodes "
                         "about the normal of a smooth shell"),
            std::string::npos)
      << error();
  joint.rigid = {0, 3, 5};
  EXPECT_EQ(error(), "");
  joint.rigid.clear();
  joint.stiffness = {1e6, 0.0, 0.0, 0.0, 1e3, 0.0};
  EXPECT_NE(error().find("ry of \"upper.centre\""), std::string::npos) << error();
  joint.stiffness[4] = 0.0;
  EXPECT_EQ(error(), "");
}

TEST(Joints, SayWhenTheyLockBodiesThatBend)
{
  const auto body = bending_plate(plate, sector_points(ring_radius, sector, n_points));
  const std::vector<Part> parts{placed(part_at("upper", 0.0), body),
                                placed(part_at("lower", 0.0), body)};
  JointOptions joint{.ends = {PartNodes{"upper", "face"}, PartNodes{"lower", "face"}},
                     .rigid = {0, 1, 2, 3, 4, 5}};
  const JoinedParts locked = joined(parts, std::vector{joint});
  ASSERT_EQ(locked.notes.size(), 0u);  // 10 of 22, as below
  joint.ends[1] = {};
  // x, y, three turns, and z of the five nodes.
  const JoinedParts held = joined(parts, std::vector{joint});
  ASSERT_EQ(held.notes.size(), 1u);
  EXPECT_EQ(
      held.notes[0],
      "joint[1] takes 10 of the 11 coordinates of \"upper\", which can hardly bend then; join "
      "fewer nodes, add interface modes there, or use springs");
  joint.rigid = {0};  // x, and the turn about z that moves the nodes along it
  EXPECT_TRUE(joined(parts, std::vector{joint}).notes.empty());
  // Bodies that differ are locked more: x, y, ry, rz, and z and rx of the five nodes.
  auto other = body;
  other.attachment_modes.bottomRightCorner(6 * n_points, n_points).setZero();
  for (Eigen::Index i = 0; i < n_points; ++i) other.attachment_modes(6 * (i + 1) + 3, 6 + i) = 1.0;
  const std::vector<Part> both{parts[0], placed(part_at("lower", 0.0), other)};
  joint = {.ends = {PartNodes{"upper", "face"}, PartNodes{"lower", "face"}},
           .rigid = {0, 1, 2, 3, 4, 5}};
  const JoinedParts rigid = joined(both, std::vector{joint});
  ASSERT_EQ(rigid.notes.size(), 1u);
  EXPECT_NE(rigid.notes[0].find("takes 14 of the 22 coordinates of \"upper\" and \"lower\""),
            std::string::npos)
      << rigid.notes[0];
}

TEST(Assembly, RefusesNodesOfTwoLiningsAndRingsOnOneCircle)
{
  AssemblyOptions options = two_plates();
  options.contacts.push_back(lining_of("upper"));
  EXPECT_NE(error_of(options).find("contact[3].face: \"upper.face\" (upper.body.h5) has nodes of "
                                   "contact[1].face = \"upper.face\" too"),
            std::string::npos)
      << error_of(options);
  std::vector<mbs_export::ModalBody> bodies = bodies_of_two_plates();
  bodies[0].rings.push_back(bodies[0].rings.front());
  bodies[0].rings.back().name = "again";
  options = two_plates();
  options.rings = {"track", "again"};
  EXPECT_NE(error_of(options, bodies)
                .find("squeal.rings: \"track\" and \"again\" lie on one circle of radius 0.13 m"),
            std::string::npos)
      << error_of(options, bodies);
  bodies[0].rings.back().height += 0.01;
  EXPECT_NE(error_of(options, bodies).find("give contact_planes in place of thickness"),
            std::string::npos)
      << error_of(options, bodies);
  options.rings = {"inner"};
  EXPECT_NE(error_of(options).find("squeal.disc: part \"disc\" (disc.body.h5): no contact ring"),
            std::string::npos)
      << error_of(options);
}

TEST(Assembly, RefusesFrictionByPressureOnAFaceWithoutArea)
{
  auto table = std::make_shared<FrictionTable>();
  table->pressures = {1e5, 1e6};
  AssemblyOptions options = two_plates();
  options.friction.table = table;
  EXPECT_NE(error_of(options).find("contact[1]: its friction depends on the pressure, but the area "
                                   "of its nodes is not known"),
            std::string::npos)
      << error_of(options);
}

TEST(Assembly, RefusesTheAreaOfAFaceThatSurroundsTheDisc)
{
  std::vector<Eigen::Vector3d> face = sector_points(0.12, 2.0 * pi, 24);
  for (const Eigen::Vector3d& x : sector_points(0.14, 2.0 * pi, 24)) face.push_back(x);
  const auto plates = plate_body(plate, face);
  const std::vector<mbs_export::ModalBody> bodies{disc_with_two_rings(), plates, plates};
  AssemblyOptions options = two_plates();
  options.rings = {"inner", "outer"};
  EXPECT_EQ(error_of(options, bodies), "");
  EXPECT_EQ(assembly(options, bodies).linings[0].area, 0.0);
  options.contacts[1].preload = {1e6, true};
  EXPECT_NE(error_of(options, bodies).find("contact[2]: the area of its nodes is not known"),
            std::string::npos)
      << error_of(options, bodies);
  options.contacts[1] = lining_of("lower");
  options.contacts[0].shares = NodeShares::by_area;
  EXPECT_NE(error_of(options, bodies).find("more than a quarter of a turn"), std::string::npos)
      << error_of(options, bodies);
  // Nor is that of two pads opposite each other known, in one set.
  std::vector<Eigen::Vector3d> both;
  for (const double turn : {0.0, pi})
    for (const double radius : {0.12, 0.14})
      for (const double angle : {-0.2, 0.0, 0.2}) {
        both.emplace_back(radius * std::cos(turn + angle) - ring_radius,
                          radius * std::sin(turn + angle), 0.0);
      }
  const auto opposite = plate_body(plate, both);
  const std::vector<mbs_export::ModalBody> others{disc_with_two_rings(), opposite, opposite};
  EXPECT_NE(error_of(options, others).find("more than a quarter of a turn"), std::string::npos)
      << error_of(options, others);
}

}  // namespace
}  // namespace chladni::squeal
